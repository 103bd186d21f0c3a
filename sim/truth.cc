#include "sim/truth.h"

#include <bit>
#include <cmath>

#include "base/check.h"

namespace piperun::sim {
namespace {

double Mix(double a, double b, double x) { return a + x * (b - a); }
Vector3d Mix(const Vector3d& a, const Vector3d& b, double x) { return a + x * (b - a); }

/// Cubic Hermite interpolant on 0 <= x <= 1 and its time derivative.
void InterpolatePosition(const TruthState& a, const TruthState& b, double x, double dt_s, TruthState& out) {
  const Vector3d chord = b.X_WB.p - a.X_WB.p;
  const Vector3d begin = dt_s * a.v_WB_W - chord;
  const Vector3d end = dt_s * b.v_WB_W - chord;
  const double y = 1 - x;
  out.X_WB.p = a.X_WB.p + x * chord + x * y * (y * begin - x * end);
  out.v_WB_W = (chord + y * (1 - 3 * x) * begin + x * (3 * x - 2) * end) / dt_s;
}

TruthState InterpolateStep(const TruthState& a, const TruthState& b, double x, double dt_s) {
  TruthState s = a;
  InterpolatePosition(a, b, x, dt_s, s);
  s.X_WB.q = a.X_WB.q * ExpSO3(x * b.dtheta_B_rad);
  s.w_WB_B = Mix(a.w_WB_B, b.w_WB_B, x);
  s.f_WB_B = Mix(a.f_WB_B, b.f_WB_B, x);
  s.v_step_W = b.v_step_W;
  s.dtheta_B_rad = b.dtheta_B_rad;
  if (a.pipe == b.pipe) s.s_m = Mix(a.s_m, b.s_m, x);
  s.chainage_m = Mix(a.chainage_m, b.chainage_m, x);
  s.water_speed_m_s = Mix(a.water_speed_m_s, b.water_speed_m_s, x);
  s.pressure_Pa = Mix(a.pressure_Pa, b.pressure_Pa, x);
  s.v_slip_W = Mix(a.v_slip_W, b.v_slip_W, x);
  return s;
}

}  // namespace

TruthWindow::TruthWindow(Rate rate, std::size_t capacity)
    : rate_(rate), ring_(std::bit_ceil(capacity)), mask_(ring_.size() - 1) {
  Demand(capacity >= 2, "a truth window holds at least two steps");
}

void TruthWindow::Push(const TruthState& state) {
  Demand(state.time == SampleTime(next_, rate_), "truth arrives step by step, beginning with step 0");
  ring_[static_cast<std::size_t>(next_) & mask_] = state;
  ++next_;
}

std::int64_t TruthWindow::StepAt(TrueTime t) const {
  auto step = static_cast<std::int64_t>(std::floor(Seconds(t) * rate_.Hz()));
  while (SampleTime(step, rate_) > t) --step;
  while (SampleTime(step + 1, rate_) <= t) ++step;
  return step;
}

TruthState Interpolate(const TruthWindow& window, TrueTime t) {
  const std::int64_t step = window.StepAt(t);
  const TruthState& a = window.at(step);
  if (a.time == t) return a;
  const TruthState& b = window.at(step + 1);
  const double x = Seconds(t - a.time) / Seconds(b.time - a.time);
  TruthState state = InterpolateStep(a, b, x, window.rate().Period_s());
  state.time = t;
  return state;
}

}  // namespace piperun::sim
