#include "sim/imu_error_params.h"

#include <array>

namespace piperun::sim {
namespace {

constexpr std::array<std::string_view, 4> kAxes{"none", "x", "y", "z"};
const Range kSmall = Range::Between(-0.5, 0.5);
const Range kTime_s{.min = 0, .max = 1e9, .min_open = true};

}  // namespace

const TriadFieldNames kGyroFields{
    .bias = "bias_rad_s",
    .bias_sd = "bias_sd_rad_s",
    .noise = "noise_rad_s_sqrtHz",
    .bias_instability = "bias_instability_rad_s",
    .rate_random_walk = "rate_random_walk_rad_s2_sqrtHz",
    .range = "range_rad_s",
    .resolution = "resolution_rad_s",
    .scale_second_order = "scale_second_order_per_rad_s",
    .temperature_bias = "temperature_bias_rad_s_per_K",
    .g_sensitivity = "g_sensitivity_rad_s_per_m_s2",
    .vibration_rectification = "vibration_rectification_rad_s_per_m2_s4",
    .gauss_markov_sd = "gauss_markov_sd_rad_s",
    .rate_ramp = "rate_ramp_rad_s2",
    .quantisation = "quantisation_rad",
};

const TriadFieldNames kAccelFields{
    .bias = "bias_m_s2",
    .bias_sd = "bias_sd_m_s2",
    .noise = "noise_m_s2_sqrtHz",
    .bias_instability = "bias_instability_m_s2",
    .rate_random_walk = "rate_random_walk_m_s3_sqrtHz",
    .range = "range_m_s2",
    .resolution = "resolution_m_s2",
    .scale_second_order = "scale_second_order_per_m_s2",
    .temperature_bias = "temperature_bias_m_s2_per_K",
    .g_sensitivity = "",
    .vibration_rectification = "vibration_rectification_m_s2_per_m2_s4",
    .gauss_markov_sd = "gauss_markov_sd_m_s2",
    .rate_ramp = "rate_ramp_m_s3",
    .quantisation = "quantisation_m_s",
};

void TriadErrorParams::Visit(ParamVisitor& v, const TriadFieldNames& names) {
  v.Vector({names.bias, "Constant bias of the three axes."}, Range::Any(), bias);
  v.Number({names.bias_sd, "Turn-on bias: standard deviation per axis, drawn once per run."},
           Range::NonNegative(), bias_sd);
  VisitScale(v, names);
  VisitOutside(v, names);
  VisitDrift(v, names);
  VisitOutput(v, names);
}

void TriadErrorParams::VisitScale(ParamVisitor& v, const TriadFieldNames& names) {
  v.Vector({"scale_error", "Constant scale-factor error of the three axes (0.01 reads 1 % too much)."},
           kSmall, scale_error);
  v.Number({"scale_error_sd", "Scale-factor error: standard deviation per axis, drawn once per run."},
           Range::Between(0, 0.1), scale_error_sd);
  v.Vector(
      {names.scale_second_order, "s2: relative change of the scale factor per unit of the input's size."},
      kSmall, scale_second_order);
  v.Vector({"scale_asymmetry", "Scale factor for positive less that for negative input, of the three axes."},
           kSmall, scale_asymmetry);
  v.Number({"scale_instability", "Scale-factor instability: standard deviation of a Gauss-Markov process."},
           Range::Between(0, 0.1), scale_instability);
  v.Number({"scale_instability_time_s", "Its correlation time."}, kTime_s, scale_instability_time_s);
  v.Matrix({"misalignment", "M, row by row: M_ij is the part of true axis j that axis i reads too much."},
           kSmall, misalignment);
  v.Number({"misalignment_sd", "Standard deviation of each off-diagonal element, drawn once per run."},
           Range::Between(0, 0.1), misalignment_sd);
}

void TriadErrorParams::VisitOutside(ParamVisitor& v, const TriadFieldNames& names) {
  v.Vector({names.temperature_bias, "Bias per kelvin above the thermal reference."}, Range::Any(),
           temperature_bias);
  v.Vector({"temperature_scale_per_K", "Scale-factor error per kelvin above the thermal reference."},
           Range::Between(-0.01, 0.01), temperature_scale);
  if (!names.g_sensitivity.empty()) {
    v.Matrix({names.g_sensitivity, "G, row by row: bias of axis i per specific force along axis j."},
             Range::Any(), g_sensitivity);
  }
  v.Vector({names.vibration_rectification,
            "Bias per square of the specific force (the axis's own; for a gyroscope the whole one)."},
           Range::Any(), vibration_rectification);
}

void TriadErrorParams::VisitDrift(ParamVisitor& v, const TriadFieldNames& names) {
  v.Number({names.quantisation, "Q of IEEE 952: rounding of the integrated output, count / sqrt(12)."},
           Range::NonNegative(), quantisation);
  v.Number({names.noise, "White noise density N (angle or velocity random walk)."}, Range::NonNegative(),
           noise);
  v.Number({names.bias_instability, "Bias instability B; the Allan deviation is flat at 0.664 B."},
           Range::NonNegative(), bias_instability);
  v.Number({names.gauss_markov_sd, "Gauss-Markov bias: standard deviation sigma of each axis."},
           Range::NonNegative(), gauss_markov_sd);
  v.Number({"gauss_markov_time_s", "Gauss-Markov bias: correlation time T."}, kTime_s, gauss_markov_time_s);
  v.Number({names.rate_random_walk, "Random walk K of the bias."}, Range::NonNegative(), rate_random_walk);
  v.Vector({names.rate_ramp, "Ramp R: the bias grows by R t since release."}, Range::Any(), rate_ramp);
}

void TriadErrorParams::VisitOutput(ParamVisitor& v, const TriadFieldNames& names) {
  v.Struct({"filter", "Bandwidth; with a filter the white noise passes through it as well."}, filter);
  v.NumberOr({names.range, "The reading saturates at plus and minus this value."}, Range::Positive(), "none",
             range);
  v.Number({names.resolution, "One count of the output register; 0 means unrounded."}, Range::NonNegative(),
           resolution);
  v.Choice({"stuck_axis", "An axis that stays at what it read last."}, kAxes, stuck_axis);
  v.Number({"stuck_from_s", "True time from which it does."}, Range::NonNegative(), stuck_from_s);
}

}  // namespace piperun::sim
