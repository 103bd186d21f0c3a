// Ball and wall alone: laws of rigid bodies that can be written down by hand.

#include <cmath>
#include <numbers>

#include "scenarios/physics/groups.h"
#include "scenarios/physics/reference_ball.h"
#include "scenarios/physics/rocking.h"

namespace piperun::scenarios::physics {
namespace {

using Ref = ReferenceBall;
using sim::BallInstant;
using sim::BallLoad;
using sim::BallWorld;

void RunFor(BallWorld& world, int steps) {
  for (int i = 0; i < steps; ++i) world.Step();
}

void CheckIncline(FigureChecks& checks) {
  const double slope = 0.1;
  const Vector3d t(std::cos(slope), 0, -std::sin(slope)), up(std::sin(slope), 0, std::cos(slope));
  const PipeBench bench({Vector3d::Zero(), 50 * t});
  BallWorld world(bench.bore(), MakeReferenceBall(0.5, 0), Rate(1000), bench.Start(0, -Ref::run_m * up),
                  CalcReferenceWeight);
  RunFor(world, 5000);
  checks.Relative("acceleration down an incline of 0.1 rad [m/s2]", world.state().v_WB_W.dot(t) / 5,
                  Ref::weight_N * std::sin(slope) / Ref::rolling_kg, 1e-10, "W sin(a) / (m + m_a + I/r2)");
}

void CheckSlideToRoll(FigureChecks& checks) {
  const PipeBench bench({Vector3d::Zero(), {50, 0, 0}});
  BallWorld world(bench.bore(), MakeReferenceBall(0.3, 0), Rate(1000),
                  bench.Start(0, {0, 0, -Ref::run_m}, {1, 0, 0}), CalcReferenceWeight);
  RunFor(world, 3000);
  checks.Near("speed at which sliding turns into rolling [m/s]", world.state().v_WB_W.x(),
              Ref::inertial_kg / Ref::rolling_kg, 1e-9, "angular momentum about the contact");
}

void CheckRollingResistance(FigureChecks& checks) {
  for (const double c_rr : {0.002, 0.02}) {
    const PipeBench bench({Vector3d::Zero(), {50, 0, 0}});
    BallWorld world(bench.bore(), MakeReferenceBall(0.5, c_rr * Ref::radius_m), Rate(1000),
                    bench.Start(0, {0, 0, -Ref::run_m}, {1.2, 0, 0}, {0, 1.2 / Ref::radius_m, 0}),
                    CalcReferenceWeight);
    RunFor(world, 2000);
    checks.Relative(
        "deceleration by rolling resistance, c_rr " + std::string(c_rr < 0.01 ? "0.002" : "0.02") + " [m/s2]",
        (1.2 - world.state().v_WB_W.x()) / 2, c_rr * Ref::weight_N / Ref::rolling_kg, 1e-6,
        "c_rr N / (m + m_a + I/r2)");
  }
}

void CheckRocking(const ReproduceOptions& options, FigureChecks& checks) {
  const double amplitude = std::numbers::pi / 6, seconds = 100 * std::fmin(1, std::fmax(0.2, options.size));
  const Rocking rocking = RockFor(seconds, amplitude, 1000, 0);
  checks.Relative("period of rocking through +-30 degrees [s]", rocking.period_s,
                  CalcRockingPeriod_s(amplitude), 5e-6, "elliptic integral");
  checks.Relative("its amplitude after " + std::to_string(static_cast<int>(seconds)) + " s [rad]",
                  rocking.last_amplitude_rad, amplitude, 1e-4, "energy");
}

/// Jitter of the specific force of a ball that rolls along a straight, far from the origin, dragged along:
/// the smooth part is a parabola over neighbouring samples, and a third difference leaves the rest.
double CalcSpuriousForce_m_s2(double rate_Hz, int samples) {
  const Vector3d from(412.3, -230.7, 61.9);
  const PipeBench bench({from, from + Vector3d(80, 61, -7)});
  const Vector3d t = bench.pipe().Eval(0).tangent_W;
  const Vector3d up = (Vector3d::UnitZ() - t.z() * t).normalized();
  BallWorld world(bench.bore(), MakeReferenceBall(0.5, 0.01 * Ref::radius_m), Rate(rate_Hz),
                  bench.Start(0, -Ref::run_m * up), [&](const BallInstant& ball) {
                    const Vector3d u = t - ball.v_WB_W;
                    return BallLoad{0.6 * u.norm() * u - Vector3d(0, 0, Ref::weight_N), -1e-5 * ball.w_WB_W};
                  });
  RunFor(world, static_cast<int>(10 * rate_Hz));
  std::vector<Vector3d> a;
  double sum = 0;
  for (int i = 0; i < samples; ++i) {
    world.Step();
    a.push_back(world.state().a_WB_W);
    if (a.size() < 4) continue;
    const std::size_t k = a.size() - 1;
    sum += (a[k] - 3 * a[k - 1] + 3 * a[k - 2] - a[k - 3]).squaredNorm() / 20;  // 1 + 9 + 9 + 1
  }
  return std::sqrt(sum / (samples - 3));
}

}  // namespace

void CheckContact(const ReproduceOptions& options, ReproduceReport& report) {
  FigureChecks checks(report, "contact");
  CheckIncline(checks);
  CheckSlideToRoll(checks);
  CheckRollingResistance(checks);
  CheckRocking(options, checks);
  for (const double rate_Hz : {1000.0, 4000.0}) {
    checks.AtMost("spurious specific force on a straight, " + std::to_string(static_cast<int>(rate_Hz)) +
                      " Hz [m/s2 rms]",
                  CalcSpuriousForce_m_s2(rate_Hz, 20000), 1e-8, "a straight has none");
  }
}

}  // namespace piperun::scenarios::physics
