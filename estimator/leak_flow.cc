#include "estimator/leak_flow.h"

#include <cmath>
#include <numbers>

#include "base/water.h"

namespace piperun::estimator {
namespace {

constexpr double kShapeIntegral = 1.198140234735592;  // of (1 + x^2)^(-5/4) over x > 0
constexpr double kLeast_m3_s = 1e-9, kMost_m3_s = 1;

/// Z_c = rho c / A.
double CalcImpedance_Pa_s_m3(const Pipe& pipe, const WaterProperties& water) {
  const double bulk_Pa = water.density_kg_m3 * water.sound_speed_m_s * water.sound_speed_m_s;
  const double h_m = pipe.wall_thickness_m;
  const double X = 2 * bulk_Pa * (pipe.radius_m() + 0.5 * h_m) / (pipe.material.young_modulus_Pa * h_m);
  return water.density_kg_m3 * water.sound_speed_m_s / std::sqrt(1 + X) / pipe.area_m2();
}

/// Share of the jet's fluctuation that lies in the band: Simpson's rule over the logarithm of f.
double CalcBandShare(double corner_Hz, double low_Hz, double high_Hz) {
  constexpr int kCells = 64;
  const double step = std::log(high_Hz / low_Hz) / kCells;
  double sum = 0;
  for (int i = 0; i <= kCells; ++i) {
    const double x = low_Hz * std::exp(step * i) / corner_Hz;
    const double g_f = x * std::pow(1 + x * x, -1.25) / kShapeIntegral;
    sum += g_f * (i == 0 || i == kCells ? 1 : 2 + 2 * (i % 2));
  }
  return sum * step / 3;
}

}  // namespace

std::optional<FlowEstimate> CalcLeakFlow(const JetModel& jet, const Pipe& pipe, double low_Hz, double high_Hz,
                                         double pressure_Pa2, double level_sigma_dB) {
  if (!(pressure_Pa2 > 0)) return std::nullopt;
  const WaterProperties water = CalcWater(10);
  const double half_impedance = 0.5 * CalcImpedance_Pa_s_m3(pipe, water);
  const double jet_m_s = std::sqrt(2 * jet.pressure_Pa / water.density_kg_m3);
  const auto excess = [&](double flow_m3_s) {
    const double hole_m = std::sqrt(4 * flow_m3_s / (std::numbers::pi * jet.discharge_coefficient * jet_m_s));
    const double rms_Pa = half_impedance * jet.relative_fluctuation * flow_m3_s;
    return rms_Pa * rms_Pa * CalcBandShare(jet.strouhal * jet_m_s / hole_m, low_Hz, high_Hz) - pressure_Pa2;
  };
  double low = kLeast_m3_s, high = kMost_m3_s;
  if (excess(low) > 0 || excess(high) < 0) return std::nullopt;
  for (int i = 0; i < 60; ++i) {
    const double middle = std::sqrt(low * high);
    (excess(middle) < 0 ? low : high) = middle;
  }
  return FlowEstimate{std::sqrt(low * high), std::hypot(0.5 * jet.calibration_dB, level_sigma_dB)};
}

}  // namespace piperun::estimator
