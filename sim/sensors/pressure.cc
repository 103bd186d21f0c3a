#include <cmath>

#include "base/check.h"
#include "base/number.h"
#include "sim/output_register.h"
#include "sim/pressure_port.h"
#include "sim/sensor.h"
#include "sim/thermal.h"

namespace piperun::sim::sensors::pressure {
namespace {

struct PressureParams : ParamsOf<PressureParams> {
  double rate_Hz = 50;
  PressurePortParams port;
  double offset_Pa = 0;
  double offset_sd_Pa = 0;
  double noise_sd_Pa = 0;
  double random_walk_Pa_s_sqrtHz = 0;
  double temperature_offset_Pa_per_K = 0;
  double reference_C = 25;
  ThermalParams thermal;
  std::optional<double> range_Pa;
  double resolution_Pa = 0;
  std::int64_t bits = 0;

  void Visit(ParamVisitor& v) override {
    v.Number({"rate_Hz", "Sampling rate."}, Range::Between(0.1, 1e5), rate_Hz);
    port.Visit(v);
    v.Number({"offset_Pa", "Constant offset."}, Range::Any(), offset_Pa);
    v.Number({"offset_sd_Pa", "Offset: standard deviation, drawn once per run."}, Range::NonNegative(),
             offset_sd_Pa);
    v.Number({"noise_sd_Pa", "White noise: standard deviation per sample."}, Range::NonNegative(),
             noise_sd_Pa);
    v.Number({"random_walk_Pa_s_sqrtHz", "Drift: random walk K of the offset, sd K sqrt(t) after time t."},
             Range::NonNegative(), random_walk_Pa_s_sqrtHz);
    VisitTemperature(v);
    VisitOutput(v);
  }
  void Check() const;
  OutputRegister MakeRegister() const;

 private:
  void VisitTemperature(ParamVisitor& v) {
    v.Number({"temperature_offset_Pa_per_K", "Change of the offset per kelvin above reference_C."},
             Range::Any(), temperature_offset_Pa_per_K);
    v.Number({"reference_C", "Temperature at which the temperature changes nothing."},
             Range::Between(-40, 125), reference_C);
    v.Struct({"thermal", "How the sensor takes on the water's temperature."}, thermal);
  }
  void VisitOutput(ParamVisitor& v) {
    v.NumberOr({"range_Pa", "The reading saturates at plus and minus this gauge pressure."},
               Range::Positive(), "none", range_Pa);
    v.Number({"resolution_Pa", "One count of the output register; 0 means unrounded."}, Range::NonNegative(),
             resolution_Pa);
    v.Integer({"bits", "Bits of the converter over twice the range, in place of a resolution; 0: none."}, 0,
              32, bits);
  }
};

void PressureParams::Check() const {
  port.Check();
  if (bits > 0 && !range_Pa) {
    throw InputError(FormatNumber(static_cast<double>(bits)) + " bits of no range; give range_Pa, or 0 bits",
                     "bits");
  }
  if (bits > 0 && resolution_Pa > 0) {
    throw InputError("bits and a resolution are two words for one thing; give one of them", "bits");
  }
}

OutputRegister PressureParams::MakeRegister() const {
  OutputRegister output;
  if (range_Pa) output.range = *range_Pa;
  output.resolution = bits > 0 ? std::ldexp(2 * *range_Pa, -static_cast<int>(bits)) : resolution_Pa;
  return output;
}

constexpr std::uint64_t kNoiseSlot = 0;
constexpr std::uint64_t kOffsetSlot = 1;
constexpr std::uint64_t kWalkSlot = 2;

/// Gauge pressure at the port: Q{ clip{ p + b0 + c_T (T - T0) + b_K + n } }, p of sim/pressure_port.h, b0 the
/// offset, b_K its random walk, T the temperature of sim/thermal.h.
class PressureSensor final : public Sensor {
 public:
  PressureSensor(const PressureParams& p, const SensorContext& context)
      : params_(p),
        rate_(p.rate_Hz),
        offset_Pa_(p.offset_Pa + p.offset_sd_Pa * context.random.Normals(0, kOffsetSlot)[0]),
        walk_step_Pa_(p.random_walk_Pa_s_sqrtHz * std::sqrt(Rate(p.rate_Hz).Period_s())),
        context_(context),
        output_(p.MakeRegister()) {}

  Rate rate() const override { return rate_; }
  TrueTime DueTime(std::int64_t k) const override { return SampleTime(k, rate_); }
  Pose X_BS() const override { return {params_.port.port_m, Quaterniond::Identity()}; }

  SensorValue Sample(std::int64_t k, const TruthWindow& window) override {
    const TrueTime due = DueTime(k);
    StepWalk(k);
    const double noise_Pa = params_.noise_sd_Pa * Normal(k, kNoiseSlot);
    const double truth_Pa = CalcPortPressure_Pa(params_.port, Interpolate(window, due), context_.gravity_W,
                                                context_.water_density_kg_m3);
    return PressureSample{
        context_.clock.ToRobot(due),
        output_.Read(truth_Pa + offset_Pa_ + CalcThermalOffset_Pa(due) + walk_Pa_ + noise_Pa)};
  }

 private:
  double Normal(std::int64_t k, std::uint64_t slot) const {
    return context_.random.Normals(static_cast<std::uint64_t>(k), slot)[0];
  }

  /// Zero at sample 0, one step for every sample since.
  void StepWalk(std::int64_t k) {
    if (walk_step_Pa_ > 0 && k > 0) walk_Pa_ += walk_step_Pa_ * Normal(k, kWalkSlot);
  }

  double CalcThermalOffset_Pa(TrueTime t) const {
    if (params_.temperature_offset_Pa_per_K == 0) return 0;
    const double T_C = CalcTemperature_C(params_.thermal, context_.water_temperature_C, Seconds(t));
    return params_.temperature_offset_Pa_per_K * (T_C - params_.reference_C);
  }

  PressureParams params_;
  Rate rate_;
  double offset_Pa_;
  double walk_step_Pa_;
  double walk_Pa_ = 0;
  SensorContext context_;
  OutputRegister output_;
};

std::unique_ptr<Sensor> Make(const Params& params, const SensorContext& context) {
  const auto& p = static_cast<const PressureParams&>(params);
  p.Check();
  return std::make_unique<PressureSensor>(p, context);
}

}  // namespace

SensorKind Kind() {
  return {"pressure", "Gauge pressure at a port of the ball, with the dynamic pressure there.", "pressure",
          MakeParams<PressureParams>, Make};
}

}  // namespace piperun::sim::sensors::pressure
