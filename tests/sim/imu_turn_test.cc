// A ball that rolls and turns: what sampling, filtering and g-sensitivity do to its heading. Figures: the
// turn error of averaged rates is (w dt)^2 / 12, that of a low-pass |H(f_spin)|, that of a g-sensitivity (Gxx
// + Gzz) / 2 per unit of gravity, all derived by hand from w_B, which a turn makes oscillate at the spin
// frequency.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "sim/imu_filter.h"
#include "sim/rolling_script.h"
#include "tests/support/imu_scene.h"

namespace piperun::sim {
namespace {

using testing::MakeImu;
using testing::ParamValues;
using testing::Play;

constexpr double kRadius_m = 0.03;
constexpr double kLoopRadius_m = 0.5;

/// 47.1 m round a rectangle with rounded corners, the speed varying by 15 %.
RollingScript MakeLoop(double speed_m_s, double modulation) {
  RollingParams p;
  p.vertices_m = {0, 0, 14, 0, 14, 9.98, 0, 9.98};
  p.corner_radius_m = kLoopRadius_m;
  p.speed_m_s = speed_m_s;
  p.speed_modulation = modulation;
  p.speed_modulation_cycles = 6;
  return RollingScript(p, kRadius_m);
}

/// Dead reckoning of a ball that rolls without slip, from the turn of each interval: p += r (R dtheta) x z.
class RollingReckoner {
 public:
  void Add(const Vector3d& dtheta) {
    const Vector3d turn_W = q_ * dtheta;
    const Vector3d step = kRadius_m * turn_W.cross(Vector3d::UnitZ());
    p_ += step;
    heading_rad_ = std::atan2(step.y(), step.x());
    q_ = q_ * ExpSO3(dtheta);
  }
  const Vector3d& p() const { return p_; }
  double heading_rad() const { return heading_rad_; }

 private:
  Quaterniond q_ = Quaterniond::Identity();
  Vector3d p_ = Vector3d::Zero();
  double heading_rad_ = 0;
};

/// The two-sample coning correction that a user applies to averaged rates.
class ConedRates {
 public:
  Vector3d Next(const Vector3d& theta) {
    const Vector3d coned = theta + before_.cross(theta) / 12;
    before_ = theta;
    return coned;
  }

 private:
  Vector3d before_ = Vector3d::Zero();
};

struct Closures {
  double rates = 0, coned_rates = 0, increments = 0;  // percent of the way
};

Closures CloseLoop(double speed_m_s, const ParamValues& more = {}, double modulation = 0.15) {
  const RollingScript script = MakeLoop(speed_m_s, modulation);
  ParamValues values{{"rate_Hz", 100.0}, {"increments", true}};
  values.insert(more.begin(), more.end());
  const auto imu = MakeImu(values);
  RollingReckoner rates, coned_rates, increments;
  ConedRates cone;
  Play(script, *imu, Rate(1000), std::llround(script.duration_s() * 100),
       [&](auto, const auto& value, auto&) {
         const auto& s = std::get<ImuSample>(value);
         rates.Add(0.01 * s.w_WS_S_rad_s);
         coned_rates.Add(cone.Next(0.01 * s.w_WS_S_rad_s));
         increments.Add(s.increments->dtheta_S_rad);
       });
  const auto percent = [&](const RollingReckoner& r) { return 100 * r.p().norm() / script.length_m(); };
  EXPECT_NEAR(script.length_m(), 47.1, 0.05);
  return {percent(rates), percent(coned_rates), percent(increments)};
}

void PrintClosures(double speed_m_s, const char* how, const Closures& c) {
  std::printf(
      "closure of 47.1 m at %.1f m/s, 100 Hz, %s: rates %.4f %%, coned by the user %.4f %%, sensor's own "
      "increments %.6f %%\n",
      speed_m_s, how, c.rates, c.coned_rates, c.increments);
}

TEST(ImuTurn, ConingCompensatedIncrementsCloseALoop) {
  const Closures slow = CloseLoop(0.6), fast = CloseLoop(0.9);
  PrintClosures(0.6, "intervals", slow);
  PrintClosures(0.9, "intervals", fast);
  EXPECT_LE(slow.coned_rates, 0.005);
  EXPECT_LE(slow.increments, 0.005);
  EXPECT_LE(fast.coned_rates, 0.03);
  EXPECT_LE(fast.increments, 0.03);
}

TEST(ImuTurn, AveragedRatesMissTheLoopByHand) {
  // Each bend loses e = (pi / 2) (w dt)^2 / 12. Straights of 9.98 m behind one bend and, going back, behind
  // three are left e and 3 e off: 2 x 9.98 m e across; those of 7, 14 and 7 m behind 0, 2 and 4 bends cancel.
  for (const double speed : {0.6, 0.9}) {
    const double turn_per_sample = speed / kRadius_m * 0.01;
    const double e = std::numbers::pi / 2 * turn_per_sample * turn_per_sample / 12;
    EXPECT_NEAR(CloseLoop(speed, {}, 0).rates / (100 * 2 * 9.98 * e / 47.1), 1, 0.02) << speed;
  }
}

TEST(ImuTurn, TheSensorsOwnAlgorithmClosesALoopFromItsInternalSamples) {
  // a boxcar of one tap changes nothing but makes the chain run step by step
  const ParamValues steps{{"gyro.filter.digital", std::string("boxcar")}, {"gyro.filter.digital_taps", 1.0}};
  const Closures slow = CloseLoop(0.6, steps), fast = CloseLoop(0.9, steps);
  PrintClosures(0.6, "internal samples", slow);
  PrintClosures(0.9, "internal samples", fast);
  EXPECT_LE(slow.increments, 0.0005);
  EXPECT_LE(fast.increments, 0.003);
  EXPECT_NEAR(CloseLoop(0.6).rates, slow.rates, 1e-6);
}

TEST(ImuTurn, WithoutItsOwnConingTheIncrementsAreTheRates) {
  ParamValues plain{{"coning_sculling", false}};
  const Closures intervals = CloseLoop(0.6, plain);
  EXPECT_NEAR(intervals.increments, intervals.rates, 1e-9);
  plain["accel.filter.digital"] = std::string("boxcar");
  plain["accel.filter.digital_taps"] = 1.0;
  const Closures steps = CloseLoop(0.6, plain);
  EXPECT_NEAR(steps.increments, steps.rates, 1e-9);
}

/// Largest error of the velocity increments of a sensor at `l` against the velocities of the script.
double FindWorstVelocityIncrement(const Vector3d& l, const ParamValues& place) {
  const RollingScript script = MakeLoop(0.9, 0);
  ParamValues values{{"rate_Hz", 100.0}, {"increments", true}};
  values.insert(place.begin(), place.end());
  const auto velocity = [&](const ScriptPoint& s) {
    return Vector3d(s.v_WB_W + s.X_WB.q * s.w_WB_B.cross(l));
  };
  double worst = 0;
  Play(script, *MakeImu(values), Rate(1000), 800, [&](std::int64_t k, const auto& value, auto&) {
    const ScriptPoint a = script.Eval(static_cast<double>(k) / 100),
                      b = script.Eval(static_cast<double>(k + 1) / 100);
    const Vector3d dv = a.X_WB.q.conjugate() * (velocity(b) - velocity(a) - 0.01 * testing::kGravity_W);
    worst = std::max(worst, (std::get<ImuSample>(value).increments->dv_S_m_s - dv).norm());
  });
  return worst;
}

TEST(ImuTurn, TheSensorsOwnVelocityIncrementsAreThoseOfTheTruth) {
  const Vector3d l(0.005, 0.002, -0.003);
  // means over a step, which turns by 0.03 rad, leave out (0.03)^2 / 24 of a force fixed in space or in the
  // body: here gravity and w^2 |l| = 5.6 m/s^2
  const double allowed = 0.01 * (5.6 + 9.81) * 0.03 * 0.03 / 24;
  const std::vector<double> place{l.x(), l.y(), l.z()};
  EXPECT_LT(FindWorstVelocityIncrement(l, {{"lever_arm_m", place},
                                           {"gyro.filter.digital", std::string("boxcar")},
                                           {"gyro.filter.digital_taps", 1.0}}),
            allowed);
  // three accelerometers at one place are one there, also without a filter
  std::vector<double> places;
  for (int i = 0; i < 3; ++i) places.insert(places.end(), place.begin(), place.end());
  EXPECT_LT(FindWorstVelocityIncrement(l, {{"accel_positions_m", places}}), allowed);
}

/// A ball at constant spin on a circle: its axis w_W turns about z.
testing::FunctionScript OnACircle(double spin_rad_s, double turn_rad_s) {
  return testing::FunctionScript([=](double t) {
    ScriptPoint s;
    s.X_WB.q = ExpSO3({0, 0, turn_rad_s * t}) * ExpSO3({0, spin_rad_s * t, -turn_rad_s * t});
    s.w_WB_B = s.X_WB.q.conjugate() * (ExpSO3({0, 0, turn_rad_s * t}) * Vector3d(0, spin_rad_s, 0));
    return s;
  });
}

TEST(ImuTurn, AveragedRatesLoseTheSquareOfTheTurnPerSampleOverTwelve) {
  for (const double spin : {20.0, 30.0}) {
    const double turn = 0.25, rate = 100;
    const auto script = OnACircle(spin, turn);
    const auto imu = MakeImu({{"rate_Hz", rate}});
    RollingReckoner reckoner;
    double first = 0;
    const std::int64_t samples = 800;
    Play(script, *imu, Rate(1000), samples, [&](std::int64_t k, const auto& value, auto&) {
      reckoner.Add(std::get<ImuSample>(value).w_WS_S_rad_s / rate);
      if (k == 0) first = reckoner.heading_rad();
    });
    const double truth = turn * (samples - 1) / rate;
    const double error = (truth - (reckoner.heading_rad() - first)) / truth;
    const double predicted = spin / rate * spin / rate / 12;
    std::printf("turn lost by averaged rates at %.0f rad/s: %.5f, (w dt)^2 / 12 = %.5f\n", spin, error,
                predicted);
    EXPECT_NEAR(error / predicted, 1, 0.1);
  }
}

/// Heading gained over the first bend of the loop (90 degrees), relative to the truth.
double CalcTurnGain(double speed_m_s, const ParamValues& filter) {
  const RollingScript script = MakeLoop(speed_m_s, 0);
  const auto imu = MakeImu([&] {
    ParamValues values{{"rate_Hz", 1000.0}};
    values.insert(filter.begin(), filter.end());
    return values;
  }());
  RollingReckoner reckoner;
  double before = 0, after = 0;
  std::int64_t count_before = 0, count_after = 0;
  // from rest 1 s, 2 s to cruise: the corner is 6.5 m away; mean headings over straights of 2 m
  const double corner_s = 1 + 2 + (6.5 - speed_m_s) / speed_m_s, bend_s = kLoopRadius_m * 1.6 / speed_m_s;
  const auto samples = std::llround((corner_s + bend_s + 4 / speed_m_s) * 1000);
  Play(script, *imu, Rate(1000), samples, [&](std::int64_t k, const auto& value, auto&) {
    reckoner.Add(std::get<ImuSample>(value).w_WS_S_rad_s / 1000);
    const double t = static_cast<double>(k + 1) / 1000;
    if (t > corner_s - 2.5 / speed_m_s && t < corner_s - 0.5 / speed_m_s)
      before += reckoner.heading_rad(), ++count_before;
    if (t > corner_s + bend_s + 0.5 / speed_m_s && t < corner_s + bend_s + 2.5 / speed_m_s)
      after += reckoner.heading_rad(), ++count_after;
  });
  return (after / static_cast<double>(count_after) - before / static_cast<double>(count_before)) /
         (std::numbers::pi / 2);
}

TEST(ImuTurn, ALowPassTakesTurnsByItsGainAtTheSpinFrequency) {
  EXPECT_NEAR(CalcTurnGain(0.6, {}), 1, 5e-4);
  for (const double speed : {0.6, 0.9}) {
    const double f_Hz = speed / kRadius_m / (2 * std::numbers::pi);
    for (const double bandwidth_Hz : {20.0, 41.0, 92.0}) {
      const double measured = CalcTurnGain(speed, {{"gyro.filter.analogue_bandwidth_Hz", bandwidth_Hz}});
      const double gain = 1 / std::hypot(1, f_Hz / bandwidth_Hz);  // the continuous first-order low-pass
      std::printf("turn gain at %.1f m/s behind %.0f Hz: %.4f, |H(%.2f Hz)| = %.4f\n", speed, bandwidth_Hz,
                  measured, f_Hz, gain);
      EXPECT_NEAR(measured, gain, 0.005) << speed << " m/s, " << bandwidth_Hz << " Hz";
    }
  }
}

TEST(ImuTurn, AButterworthPairTakesTurnsByItsGainAtTheSpinFrequency) {
  const double f_Hz = 0.9 / kRadius_m / (2 * std::numbers::pi), bandwidth_Hz = 10;
  const double measured = CalcTurnGain(0.9, {{"gyro.filter.digital", std::string("low_pass_2")},
                                             {"gyro.filter.digital_bandwidth_Hz", bandwidth_Hz}});
  const double x = f_Hz / bandwidth_Hz;
  EXPECT_NEAR(measured, 1 / std::sqrt(1 + x * x * x * x), 0.005);
}

/// Heading drift of a ball that rolls straight, from its gyroscope; rad/s.
double CalcHeadingDrift(const ParamValues& values) {
  const auto script = testing::Spinning({0, 30, 0});
  const auto imu = MakeImu(values);
  Quaterniond q = Quaterniond::Identity();
  const std::int64_t samples = 400 * 20;
  Play(script, *imu, Rate(1000), samples, [&](auto, const auto& value, auto&) {
    q = q * ExpSO3(std::get<ImuSample>(value).w_WS_S_rad_s / 400);
  });
  return LogSO3(q * ExpSO3({0, 30 * 20.0, 0}).conjugate()).z() / 20;
}

TEST(ImuTurn, DiagonalGSensitivityDriftsTheHeadingByHalfItsSum) {
  const double deg_s_per_g = std::numbers::pi / 180 / 9.80665;
  const double xx = 0.1 * deg_s_per_g, yy = 0.3 * deg_s_per_g, zz = 0.05 * deg_s_per_g;
  const double drift = CalcHeadingDrift(
      {{"gyro.g_sensitivity_rad_s_per_m_s2", std::vector<double>{xx, 0, 0, 0, yy, 0, 0, 0, zz}}});
  const double expected = (xx + zz) / 2 * 9.80665;
  std::printf("heading drift %.6f deg/s, (Gxx + Gzz) / 2 g = %.6f deg/s\n", drift * 180 / std::numbers::pi,
              expected * 180 / std::numbers::pi);
  EXPECT_NEAR(drift / expected, 1, 0.01);
}

TEST(ImuTurn, AntisymmetricGSensitivityAndConstantBiasDoNotDriftTheHeading) {
  const double c = 0.1 * std::numbers::pi / 180;  // what would drift by 0.1 deg/s if it did not rotate
  const double g = c / 9.80665;
  EXPECT_LT(std::abs(CalcHeadingDrift(
                {{"gyro.g_sensitivity_rad_s_per_m_s2", std::vector<double>{g, 0, 0, 0, 0, 0, 0, 0, -g}}})),
            0.02 * c);
  EXPECT_LT(std::abs(CalcHeadingDrift({{"gyro.bias_rad_s", std::vector<double>{c, 0, c}}})), 0.02 * c);
}

}  // namespace
}  // namespace piperun::sim
