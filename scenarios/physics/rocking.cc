#include "scenarios/physics/rocking.h"

#include <cmath>
#include <numbers>
#include <vector>

#include "scenarios/physics/reference_ball.h"

namespace piperun::scenarios::physics {
namespace {

using Ref = ReferenceBall;

/// When, after `state`, a ball moving across the lowest line at y is on it: y + v t + a t^2/2 = 0, |t| < dt.
double SolveCrossing_s(const sim::BallState& state) {
  const double y = state.X_LB.p.y(), v = state.v_WB_W.y(), a = state.a_WB_W.y();
  double t = -y / v;
  for (int i = 0; i < 5; ++i) t -= (y + t * (v + 0.5 * a * t)) / (v + a * t);
  return t;
}

}  // namespace

double CalcRockingPeriod_s(double amplitude_rad) {
  double a = 1, b = std::cos(amplitude_rad / 2);
  for (int i = 0; i < 8; ++i) {
    const double mean = 0.5 * (a + b);
    b = std::sqrt(a * b);
    a = mean;
  }
  return 2 * std::numbers::pi / std::sqrt(Ref::weight_N / (Ref::rolling_kg * Ref::run_m)) / a;
}

Rocking RockFor(double seconds, double amplitude_rad, double rate_Hz, double rolling_length_m) {
  const PipeBench bench({Vector3d::Zero(), {5, 0, 0}});
  const Vector3d offset = Ref::run_m * Vector3d(0, std::sin(amplitude_rad), -std::cos(amplitude_rad));
  sim::BallWorld world(bench.bore(), MakeReferenceBall(0.5, rolling_length_m), Rate(rate_Hz),
                       bench.Start(1, offset), CalcReferenceWeight);
  Rocking rocking;
  std::vector<double> crossings_s;
  double largest = 0, y_before = offset.y();
  while (Seconds(world.state().time) < seconds) {
    world.Step();
    const sim::BallState& state = world.state();
    const double y = state.X_LB.p.y();
    if (y_before * y < 0) {
      crossings_s.push_back(Seconds(state.time) + SolveCrossing_s(state));
      rocking.last_amplitude_rad = largest;
      largest = 0;
    }
    y_before = y;
    rocking.end_rad = std::atan2(y, -state.X_LB.p.z());
    largest = std::fmax(largest, std::abs(rocking.end_rad));
  }
  if (crossings_s.size() > 1) {
    const auto half_swings = static_cast<double>(crossings_s.size() - 1);
    rocking.period_s = 2 * (crossings_s.back() - crossings_s.front()) / half_swings;
  }
  return rocking;
}

}  // namespace piperun::scenarios::physics
