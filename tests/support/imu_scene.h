#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <memory>

#include "sim/sensor.h"
#include "tests/support/function_script.h"
#include "tests/support/set_params.h"

namespace piperun::testing {

inline const Vector3d kGravity_W(0, 0, -9.80665);

inline sim::SensorContext MakeImuContext(Rate physics = Rate(1000), std::uint64_t run = 0) {
  return {RandomStream(7, "imu0", run), {}, kGravity_W, physics};
}

inline std::unique_ptr<sim::Sensor> MakeImu(const ParamValues& values,
                                            const sim::SensorContext& context = MakeImuContext()) {
  const sim::SensorKind& kind = FindKind(sim::SensorKinds(), "imu");
  return kind.make(*MakeParamsOf(kind, values), context);
}

inline ImuSample TakeImu(sim::Sensor& imu, std::int64_t k, const sim::TruthWindow& window) {
  return std::get<ImuSample>(imu.Sample(k, window));
}

/// Constant velocity, turning at a constant rate about an axis of the body.
inline FunctionScript Spinning(const Vector3d& w_B) {
  return FunctionScript([=](double t) {
    sim::ScriptPoint s;
    s.X_WB.q = ExpSO3(t * w_B);
    s.w_WB_B = w_B;
    return s;
  });
}

/// Plays a script to a sensor until `samples` have been taken; `visit(k, sample, window)`.
template <class Visit>
void Play(const sim::Script& script, sim::Sensor& imu, Rate physics, std::int64_t samples,
          const Visit& visit) {
  const double dt = physics.Period_s();
  sim::TruthWindow window(physics, 256);
  sim::TruthState state;
  std::int64_t n = 0;
  const Duration reach = imu.lookahead() + SampleOffset(1, physics) + Duration(1);
  for (std::int64_t k = 0; k < samples; ++k) {
    for (; n == 0 || window.latest_time() < imu.DueTime(k) + reach; ++n) {
      const double t = static_cast<double>(n) * dt;
      const sim::ScriptPoint point = script.Eval(t);
      state.dtheta_B_rad =
          n == 0 ? Vector3d(Vector3d::Zero()) : LogSO3(state.X_WB.q.conjugate() * point.X_WB.q);
      state.v_step_W = n == 0 ? point.v_WB_W : sim::CalcMeanVelocity(script, t - dt, dt);
      state.time = SampleTime(n, physics);
      state.X_WB = point.X_WB;
      state.v_WB_W = point.v_WB_W;
      state.w_WB_B = point.w_WB_B;
      state.f_WB_B = point.X_WB.q.conjugate() * (point.a_WB_W - kGravity_W);
      window.Push(state);
    }
    visit(k, imu.Sample(k, window), window);
  }
}

}  // namespace piperun::testing
