// A strapdown integrator that knows nothing of forces must return the trajectory.

#include <string>

#include "scenarios/assemble.h"
#include "scenarios/load.h"
#include "scenarios/physics/groups.h"

namespace piperun::scenarios::physics {
namespace {

/// v += R dv + g dt;  p += v dt;  R = R Exp(dtheta).
struct Strapdown {
  explicit Strapdown(const sim::TruthState& start)
      : p_W(start.X_WB.p), v_W(start.v_WB_W), q_WB(start.X_WB.q) {}

  void Feed(const Vector3d& dtheta_B_rad, const Vector3d& dv_B_m_s, const Vector3d& gravity_W, double dt_s) {
    v_W += q_WB * dv_B_m_s + gravity_W * dt_s;
    p_W += v_W * dt_s;
    q_WB = (q_WB * ExpSO3(dtheta_B_rad)).normalized();
  }

  Vector3d p_W, v_W;
  Quaterniond q_WB;
};

struct Closure {
  double length_m = 0;
  double error_m = 0;
  double angle_rad = 0;
  sim::MotionStatus status = sim::MotionStatus::kRunning;
};

Closure IntegrateAlong(const Scenario& scenario) {
  const auto assembly = Assemble(scenario);
  sim::Motion& motion = *assembly->motion;
  const Vector3d gravity_W(0, 0, -scenario.gravity_m_s2);
  const double dt_s = motion.rate().Period_s();
  Strapdown strapdown(motion.state());
  Vector3d v_before = motion.state().v_step_W;
  while (motion.status() == sim::MotionStatus::kRunning &&
         Seconds(motion.state().time) < scenario.mission.time_limit_s) {
    const Quaterniond q_BW = motion.state().X_WB.q.conjugate();
    motion.Step();
    const sim::TruthState& state = motion.state();
    strapdown.Feed(state.dtheta_B_rad, q_BW * (state.v_step_W - v_before - gravity_W * dt_s), gravity_W,
                   dt_s);
    v_before = state.v_step_W;
  }
  const sim::TruthState& end = motion.state();
  return {end.chainage_m, (strapdown.p_W - end.X_WB.p).norm(), strapdown.q_WB.angularDistance(end.X_WB.q),
          motion.status()};
}

}  // namespace

void CheckClosure(const ReproduceOptions& options, ReproduceReport& report) {
  FigureChecks checks(report, "closure");
  const std::string seed = "seed=" + std::to_string(options.seed);
  const Closure bend = IntegrateAlong(LoadScenario("closure", {seed}));
  checks.AtLeast("length of the run with a bend [m]", bend.length_m, 90, "scenario closure");
  checks.AtMost("re-integration error there [m]", bend.error_m, 1e-7, "the trajectory itself");
  const Closure network = IntegrateAlong(
      LoadScenario("quickstart", {seed, "motion.stream.turbulence.on=true", "mission.time_limit_s=3600"}));
  checks.AtLeast("length of the run through tee, bend, reducer and riser [m]", network.length_m, 270,
                 "scenario quickstart, with turbulence");
  checks.AtMost("re-integration error there [m]", network.error_m, 1e-6, "the trajectory itself");
  checks.AtMost("error of the attitude there [rad]", network.angle_rad, 1e-9, "the trajectory itself");
}

}  // namespace piperun::scenarios::physics
