// Statistics of the velocity fluctuations that a ball meets.

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/number.h"
#include "scenarios/physics/groups.h"
#include "sim/turbulence_statistics.h"

namespace piperun::scenarios::physics {
namespace {

/// On the axis of a bore of 150 mm, u* = 0.5 m/s.
sim::TurbulentPlace MakePlace() {
  sim::TurbulentPlace place;
  place.radius_m = 0.075;
  place.friction_velocity_m_s = 0.5;
  return place;
}

void CheckStatistics(const ReproduceOptions& options, FigureChecks& checks) {
  const auto blocks = std::max<std::int64_t>(2000, std::llround(40000 * options.size));
  // the mean of three axes; four standard deviations where the record is shorter than asked for
  const double wide = std::sqrt(std::fmax(1, 40000.0 / static_cast<double>(blocks)));
  const Vector3d rms = 0.5 * Vector3d(0.8, 0.7, 0.7);
  const double time_s = 2 * (0.64 + 0.49 + 0.49) / 3 * 0.25 / (5 * 1.35 * 0.125 / 0.075);
  const sim::TurbulenceCoefficients c = sim::CalcTurbulenceCoefficients({}, 0, 1);
  for (const double rate_Hz : {1000.0, 2000.0, 4000.0, 8000.0}) {
    const sim::TurbulenceStatistics found =
        sim::MeasureTurbulence(MakePlace(), c, Rate(rate_Hz), time_s, blocks, options.seed);
    const std::string at = ", " + FormatDigits(rate_Hz, 4) + " Hz";
    const auto mean = [](const Vector3d& ratios) { return ratios.mean(); };
    checks.Near("rms velocity over what is asked for" + at, mean(found.rms_m_s.cwiseQuotient(rms)), 1, 0.03,
                "stationary variance");
    checks.Near("integral time over what is asked for" + at, mean(found.integral_time_s / time_s), 1,
                0.03 * wide, "T1 + T2 = 2 sigma2/(C0 eps)");
    const double omega = sim::CalcLocalTurbulence(MakePlace(), c).omega_1_s;
    checks.Near("rms acceleration over what is asked for" + at,
                mean(found.acceleration_m_s2.cwiseQuotient(omega * rms)), 1, 0.05, "sigma / sqrt(T1 T2)");
  }
}

void CheckTracers(const ReproduceOptions& options, FigureChecks& checks) {
  constexpr double kChiSquare9AtOnePercent = 21.666;
  const auto tracers = std::max<std::int64_t>(5000, std::llround(30000 * options.size));
  const sim::TurbulenceCoefficients c = sim::CalcTurbulenceCoefficients({}, 0, 1);
  const auto counts = sim::TraceTracers(c, tracers, 10, 4, 5e-3, options.seed);
  const double expected = static_cast<double>(tracers) / 10;
  double chi_square = 0;
  for (const std::int64_t count : counts) {
    chi_square +=
        (static_cast<double>(count) - expected) * (static_cast<double>(count) - expected) / expected;
  }
  checks.AtMost("chi-square of " + std::to_string(tracers) + " tracers in ten rings of equal area",
                chi_square, kChiSquare9AtOnePercent, "uniform: p > 0.01 with nine degrees of freedom");
}

}  // namespace

void CheckTurbulence(const ReproduceOptions& options, ReproduceReport& report) {
  FigureChecks checks(report, "turbulence");
  CheckStatistics(options, checks);
  CheckTracers(options, checks);
}

}  // namespace piperun::scenarios::physics
