#pragma once

#include <functional>
#include <limits>

#include "sim/script.h"
#include "sim/truth.h"

namespace piperun::testing {

/// A smooth motion given as a function of time.
class FunctionScript final : public sim::Script {
 public:
  explicit FunctionScript(std::function<sim::ScriptPoint(double)> eval) : eval_(std::move(eval)) {}
  double duration_s() const override { return std::numeric_limits<double>::infinity(); }
  sim::ScriptPoint Eval(double t_s) const override { return eval_(t_s); }
  const std::vector<double>& knots_s() const override { return knots_; }

 private:
  std::function<sim::ScriptPoint(double)> eval_;
  std::vector<double> knots_;
};

/// Truth of steps 0 .. `steps` of a script, all of it in one window.
inline sim::TruthWindow MakeTruth(const sim::Script& script, Rate rate, std::int64_t steps,
                                  const Vector3d& gravity_W) {
  const double dt = rate.Period_s();
  sim::TruthWindow window(rate, static_cast<std::size_t>(steps) + 1);
  sim::TruthState state;
  for (std::int64_t k = 0; k <= steps; ++k) {
    const double t = static_cast<double>(k) * dt;
    const sim::ScriptPoint point = script.Eval(t);
    state.dtheta_B_rad =
        k == 0 ? Vector3d(Vector3d::Zero()) : LogSO3(state.X_WB.q.conjugate() * point.X_WB.q);
    state.v_step_W = k == 0 ? point.v_WB_W : sim::CalcMeanVelocity(script, t - dt, dt);
    state.time = SampleTime(k, rate);
    state.X_WB = point.X_WB;
    state.v_WB_W = point.v_WB_W;
    state.w_WB_B = point.w_WB_B;
    state.f_WB_B = point.X_WB.q.conjugate() * (point.a_WB_W - gravity_W);
    window.Push(state);
  }
  return window;
}

}  // namespace piperun::testing
