// How errors fall with the step, seen from three steps in a row: log2 of the ratio of their differences.

#include <cmath>
#include <functional>

#include "scenarios/physics/groups.h"
#include "scenarios/physics/reference_ball.h"
#include "scenarios/physics/rocking.h"

namespace piperun::scenarios::physics {
namespace {

using Ref = ReferenceBall;

double CalcOrder(double rate_Hz, const std::function<double(double)>& result) {
  const double coarse = result(rate_Hz), middle = result(2 * rate_Hz), fine = result(4 * rate_Hz);
  return std::log2(std::abs((coarse - middle) / (middle - fine)));
}

/// Where a ball is after two seconds that starts from rest in 1 m/s of water, with drag as the speed squared.
double RollStraight_m(double rate_Hz) {
  const PipeBench bench({Vector3d::Zero(), {50, 0, 0}});
  sim::BallWorld world(bench.bore(), MakeReferenceBall(0.5, 0.01 * Ref::radius_m), Rate(rate_Hz),
                       bench.Start(1, {0, 0, -Ref::run_m}), [](const sim::BallInstant& ball) {
                         const Vector3d u = Vector3d::UnitX() - ball.v_WB_W;
                         return sim::BallLoad{u.norm() * u - Vector3d(0, 0, Ref::weight_N), Vector3d::Zero()};
                       });
  while (Seconds(world.state().time) < 2) world.Step();
  return world.state().X_LB.p.x();
}

/// Angle up the wall, after two seconds, of a ball that rolls along the pipe and rocks, against rolling
/// resistance: the contact normal turns all the time.
double RollAndRock_rad(double rate_Hz) {
  const PipeBench bench({Vector3d::Zero(), {50, 0, 0}});
  const Vector3d out(0, std::sin(0.5), -std::cos(0.5)), v(1, 0, 0);
  sim::BallWorld world(bench.bore(), MakeReferenceBall(0.5, 0.02 * Ref::radius_m), Rate(rate_Hz),
                       bench.Start(1, Ref::run_m * out, v, v.cross(out) / Ref::radius_m),
                       CalcReferenceWeight);
  while (Seconds(world.state().time) < 2) world.Step();
  return std::atan2(world.state().X_LB.p.y(), -world.state().X_LB.p.z());
}

}  // namespace

void CheckOrder(const ReproduceOptions&, ReproduceReport& report) {
  FigureChecks checks(report, "order of the step");
  checks.AtLeast("rolling along a straight, with drag", CalcOrder(50, RollStraight_m), 1.9, "leapfrog: 2");
  checks.AtLeast("rocking, period",
                 CalcOrder(100, [](double rate_Hz) { return RockFor(10, 0.5, rate_Hz, 0).period_s; }), 1.9,
                 "leapfrog: 2");
  checks.AtLeast("rolling and rocking against rolling resistance", CalcOrder(1000, RollAndRock_rad), 0.95,
                 "friction on a turning normal: 1");
}

}  // namespace piperun::scenarios::physics
