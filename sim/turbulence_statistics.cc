#include "sim/turbulence_statistics.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/random.h"

namespace piperun::sim {
namespace {

/// T from the variance of the displacement over that of the velocity, by iteration from long blocks down.
double SolveIntegralTime(double displacement_over_rms2_s2, double ratio, double block_s) {
  double time_s = 0.5 * displacement_over_rms2_s2 / block_s;
  for (int i = 0; i < 60; ++i) {
    const double t2 = ratio * time_s, t1 = time_s - t2;
    const double end =
        (t1 * t1 * t1 * -std::expm1(-block_s / t1) - t2 * t2 * t2 * -std::expm1(-block_s / t2)) / (t1 - t2);
    time_s = (0.5 * displacement_over_rms2_s2 + end) / block_s;
  }
  return time_s;
}

struct Sums {
  Vector3d velocity2 = Vector3d::Zero(), acceleration2 = Vector3d::Zero(), displacement2 = Vector3d::Zero();
  Vector3d displacement = Vector3d::Zero();  // of the block so far

  void Add(const Vector3d& before_W, const WaterFluctuation& water, double dt_s) {
    velocity2 += water.velocity_W.cwiseAbs2();
    acceleration2 += water.acceleration_W.cwiseAbs2();
    displacement += 0.5 * dt_s * (before_W + water.velocity_W);
  }
  void EndBlock() {
    displacement2 += displacement.cwiseAbs2();
    displacement.setZero();
  }
};

struct Tracer {
  Vector3d p = Vector3d::Zero();  // in the cross-section y, z
  TurbulenceState state;
};

TurbulentPlace MakeUnitPlace(const Vector3d& offset) {
  TurbulentPlace place;
  place.offset_W = offset;
  place.radius_m = 1;
  place.friction_velocity_m_s = 1;
  return place;
}

/// Across the cross-section only: what happens along the pipe moves nobody in or out.
void Drift(Tracer& tracer, const LocalTurbulence& local, double dt) {
  Vector3d step = dt * local.Scale(tracer.state.xi_W);
  step.x() = 0;
  tracer.p += step;
  const double r = tracer.p.norm();
  if (r <= 1) return;
  const Vector3d out = tracer.p / r;
  tracer.p = (2 - r) * out;
  tracer.state.xi_W -= 2 * out.dot(tracer.state.xi_W) * out;
  tracer.state.eta_W -= 2 * out.dot(tracer.state.eta_W) * out;
}

Tracer Release(const RandomStream& noise) {
  const auto u = noise.Uniforms(0, 1);
  const double r = std::sqrt(u[0]), angle = 2 * std::numbers::pi * u[1];
  return {{0, r * std::cos(angle), r * std::sin(angle)}, StartTurbulence(noise.SixNormals(0, 0))};
}

}  // namespace

TurbulenceStatistics MeasureTurbulence(const TurbulentPlace& place, const TurbulenceCoefficients& c,
                                       Rate rate, double nominal_s, std::int64_t blocks, std::uint64_t seed) {
  const RandomStream noise(seed, "turbulence statistics", 0);
  const LocalTurbulence local = CalcLocalTurbulence(place, c);
  const double dt_s = rate.Period_s();
  const auto steps = static_cast<std::int64_t>(std::lround(5 * nominal_s / dt_s));
  TurbulenceState state = StartTurbulence(noise.SixNormals(0, 0));
  Sums sums;
  for (std::int64_t step = 1; step <= blocks * steps; ++step) {
    const Vector3d before = local.Scale(state.xi_W);
    state =
        StepTurbulence(state, local, c, true, noise.SixNormals(static_cast<std::uint64_t>(step), 0), dt_s);
    sums.Add(before, CalcFluctuation(state, local, Vector3d::Zero()), dt_s);
    if (step % steps == 0) sums.EndBlock();
  }
  const auto samples = static_cast<double>(blocks * steps);
  const Vector3d over =
      (sums.displacement2 / static_cast<double>(blocks)).cwiseQuotient(sums.velocity2 / samples);
  TurbulenceStatistics result{(sums.velocity2 / samples).cwiseSqrt(), Vector3d::Zero(),
                              (sums.acceleration2 / samples).cwiseSqrt(), blocks};
  for (int i = 0; i < 3; ++i) {
    result.integral_time_s[i] =
        SolveIntegralTime(over[i], c.time_scale_ratio, static_cast<double>(steps) * dt_s);
  }
  return result;
}

std::vector<std::int64_t> TraceTracers(const TurbulenceCoefficients& c, std::int64_t tracers, int rings,
                                       double duration, double step, std::uint64_t seed) {
  std::vector<std::int64_t> counts(static_cast<std::size_t>(rings));
  const auto steps = static_cast<std::uint64_t>(std::llround(duration / step));
  for (std::int64_t i = 0; i < tracers; ++i) {
    const RandomStream noise(seed, "tracers", static_cast<std::uint64_t>(i));
    Tracer tracer = Release(noise);
    for (std::uint64_t k = 1; k <= steps; ++k) {
      Drift(tracer, CalcLocalTurbulence(MakeUnitPlace(tracer.p), c), 0.5 * step);
      const LocalTurbulence local = CalcLocalTurbulence(MakeUnitPlace(tracer.p), c);
      tracer.state = StepTurbulence(tracer.state, local, c, false, noise.SixNormals(k, 0), step);
      Drift(tracer, local, 0.5 * step);
    }
    const double area = tracer.p.squaredNorm();
    ++counts[static_cast<std::size_t>(std::min(area * rings, rings - 1.0))];
  }
  return counts;
}

}  // namespace piperun::sim
