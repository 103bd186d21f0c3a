// Balls that sink in still water, freely and in a riser, and one in a vortex.

#include <cmath>
#include <numbers>
#include <vector>

#include "base/number.h"
#include "scenarios/physics/groups.h"
#include "scenarios/physics/reference_ball.h"
#include "sim/fluid_load.h"

namespace piperun::scenarios::physics {
namespace {

using Ref = ReferenceBall;

constexpr WaterProperties kWater{.density_kg_m3 = 1000, .kinematic_viscosity_m2_s = 1e-6};
constexpr double kFreeBore_m = 1e6;

sim::FluidLoadCoefficients MakeCoefficients(double relative_density, double bore_radius_m) {
  sim::BallParams ball;
  ball.radius_m = Ref::radius_m;
  ball.density_kg_m3 = 1000 * relative_density;
  ball.added_mass_coefficient = 0.5;
  const std::vector<double> bores_m{bore_radius_m};
  return sim::CalcFluidLoadCoefficients(ball, {}, kWater, {0, 0, -Ref::gravity_m_s2}, bores_m);
}

/// Water at rest around a ball on the axis of a bore.
sim::WaterAtBall MakeStillWater(double bore_radius_m) {
  sim::WaterAtBall water;
  water.bore_radius_m = bore_radius_m;
  water.axis_W = Vector3d::UnitZ();
  water.wall_gap_m = bore_radius_m - Ref::radius_m;
  return water;
}

/// Speed after 30 s, from rest.
double Sink_m_s(double rate_Hz, double bore_radius_m) {
  const PipeBench bench({{0, 0, 100}, {0, 0, 0}});
  const sim::FluidLoadCoefficients c = MakeCoefficients(1.1, bore_radius_m);
  const sim::WaterAtBall water = MakeStillWater(bore_radius_m);
  sim::BallWorld world(bench.bore(), MakeReferenceBall(0.5, 0), Rate(rate_Hz),
                       bench.Start(1, Vector3d::Zero()), [&](const sim::BallInstant& ball) {
                         return sim::BallLoad{
                             sim::CalcFluidLoad(c, ball.v_WB_W, Vector3d::Zero(), water).Force_W_N(),
                             Vector3d::Zero()};
                       });
  while (Seconds(world.state().time) < 30) world.Step();
  return -world.state().v_WB_W.z();
}

/// Root of W = 1/2 rho A C_D(V d/nu) V^2, with Brown and Lawler's law written down once more.
double SolveFreeSpeed_m_s() {
  const double d = 2 * Ref::radius_m, area = std::numbers::pi * Ref::radius_m * Ref::radius_m;
  double low = 1e-3, high = 5;
  for (int i = 0; i < 200; ++i) {
    const double v = 0.5 * (low + high), re = v * d / 1e-6;
    const double drag = 24 / re * (1 + 0.15 * std::pow(re, 0.681)) + 0.407 / (1 + 8710 / re);
    (500 * area * drag * v * v < Ref::weight_N ? low : high) = v;
  }
  return low;
}

void CheckTerminalSpeeds(FigureChecks& checks) {
  const double free_m_s = SolveFreeSpeed_m_s();
  const sim::Reynolds re(free_m_s * 2 * Ref::radius_m / 1e-6);
  const double tube_m_s = free_m_s * sim::CalcWallFactor(sim::WallFactorLaw::kKehlenbeckDiFelice, 0.4, re);
  checks.Relative("terminal speed of the reference ball, free [m/s]", free_m_s, 0.420595, 0.003,
                  "published root with Clift & Gauvin's refit; the laws differ by 0.6 %");
  for (const double rate_Hz : {100.0, 1000.0, 4000.0}) {
    const std::string step = ", steps of " + FormatDigits(1000 / rate_Hz, 3) + " ms [m/s]";
    checks.Relative("terminal speed, free" + step, Sink_m_s(rate_Hz, kFreeBore_m), free_m_s, 1e-9,
                    "force balance solved anew");
    checks.Relative("terminal speed in a tube, d/D = 0.4" + step, Sink_m_s(rate_Hz, Ref::bore_radius_m),
                    tube_m_s, 1e-9, "wall factor times the free speed");
  }
}

/// Drag coefficient of the reference ball that rolls along a plane in still water, from all that resists it:
/// drag, and the water's torque at the rim.
double CalcRollingDrag(double reynolds) {
  const sim::FluidLoadCoefficients c = MakeCoefficients(1.1, kFreeBore_m);
  sim::WaterAtBall water = MakeStillWater(kFreeBore_m);
  water.axis_W = Vector3d::UnitX();
  water.from_wall_W = Vector3d::UnitZ();
  water.wall_gap_m = 0;
  const double r = Ref::radius_m, v = reynolds * 1e-6 / (2 * r);
  const auto load = sim::CalcFluidLoad(c, {v, 0, 0}, {0, v / r, 0}, water);
  const double resistance_N = -load.drag_W_N.x() - load.spin_torque_W_N_m.y() / r;
  return resistance_N / (500 * std::numbers::pi * r * r * v * v);
}

void CheckRollingDrag(FigureChecks& checks) {
  for (const double reynolds : {1e2, 1e3, 1e4}) {
    const double l = std::log10(reynolds);
    checks.Relative("C_D of a ball rolling down a plane in still water, Re " + FormatDigits(reynolds, 3),
                    CalcRollingDrag(reynolds),
                    std::pow(10, 3.02 - 1.89 * l + 0.411 * l * l - 0.033 * l * l * l), 1e-6,
                    "Jan & Chen 1997 (their fit, from memory)");
  }
}

/// Solid rotation with an axial stream: a ball of the water's own density, released with it, stays with it.
double CalcSwirlError_m(double rate_Hz) {
  const double omega = 5, along = 0.5, radius = 0.03;
  const PipeBench bench({Vector3d::Zero(), {50, 0, 0}});
  const sim::FluidLoadCoefficients c = MakeCoefficients(1, Ref::bore_radius_m);
  const Vector3d spin(omega, 0, 0);
  const auto velocity = [&](const Vector3d& p) { return Vector3d(along, -omega * p.z(), omega * p.y()); };
  const Vector3d offset(0, radius, 0), p_start = Vector3d(1, 0, 0) + offset;
  sim::TubeBall ball = MakeReferenceBall(0, 0);
  ball.mass_kg = 1500 * Ref::volume_m3;
  sim::BallWorld world(
      bench.bore(), ball, Rate(rate_Hz), bench.Start(1, offset, velocity(p_start), spin),
      [&](const sim::BallInstant& at) {
        sim::WaterAtBall water = MakeStillWater(Ref::bore_radius_m);
        water.axis_W = Vector3d::UnitX();
        water.velocity_W = velocity(at.p_LB);
        water.acceleration_W = {0, -omega * omega * at.p_LB.y(), -omega * omega * at.p_LB.z()};
        water.spin_W = spin;
        const auto load = sim::CalcFluidLoad(c, at.v_WB_W, at.w_WB_W, water);
        return sim::BallLoad{load.Force_W_N(), load.spin_torque_W_N_m};
      });
  while (Seconds(world.state().time) < 2 * std::numbers::pi / omega) world.Step();
  const Vector3d& p = world.state().X_LB.p;
  return std::abs(std::hypot(p.y(), p.z()) - radius);
}

}  // namespace

void CheckFall(const ReproduceOptions&, ReproduceReport& report) {
  FigureChecks checks(report, "fall and swirl");
  CheckTerminalSpeeds(checks);
  CheckRollingDrag(checks);
  checks.AtMost("a ball like water leaves its streamline in a swirl, per turn [m]", CalcSwirlError_m(1000),
                1e-6, "SG = 1 moves with the water");
}

}  // namespace piperun::scenarios::physics
