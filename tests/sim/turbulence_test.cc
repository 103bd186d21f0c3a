#include "sim/turbulence.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "sim/random_oscillator.h"
#include "sim/stream_fluctuations.h"
#include "sim/turbulence_statistics.h"

namespace piperun::sim {
namespace {

/// The covariance and the matrix of one step by brute force: a thousand times a thousandth.
struct BruteStep {
  Eigen::Matrix2d keep = Eigen::Matrix2d::Identity();
  Eigen::Matrix2d noise = Eigen::Matrix2d::Zero();
  Eigen::Vector2d push = Eigen::Vector2d::Zero();
};

BruteStep IntegrateStep(double omega, double gamma, double dt) {
  constexpr int kParts = 4000;
  const double h = dt / kParts;
  Eigen::Matrix2d m, q = Eigen::Matrix2d::Zero();
  m << 0, omega, -omega, -gamma;
  q(1, 1) = 2 * gamma;
  // Runge-Kutta for dA = M A, dQ = M Q + Q M' + B B', dp = M p + (1, 0)
  BruteStep step;
  const auto slope = [&](const BruteStep& s) {
    return BruteStep{m * s.keep, m * s.noise + s.noise * m.transpose() + q,
                     m * s.push + Eigen::Vector2d(1, 0)};
  };
  const auto add = [](const BruteStep& s, double f, const BruteStep& d) {
    return BruteStep{s.keep + f * d.keep, s.noise + f * d.noise, s.push + f * d.push};
  };
  for (int i = 0; i < kParts; ++i) {
    const BruteStep k1 = slope(step), k2 = slope(add(step, h / 2, k1));
    const BruteStep k3 = slope(add(step, h / 2, k2)), k4 = slope(add(step, h, k3));
    step = add(add(add(add(step, h / 6, k1), h / 3, k2), h / 3, k3), h / 6, k4);
  }
  return step;
}

TEST(RandomOscillator, StepIsThatOfAFineIntegration) {
  struct Case {
    double omega, gamma;
  };
  // overdamped (T2/T = 0.1), critical, narrow-band, very unlike time scales, much slower than the step
  for (const Case& c :
       {Case{33.3, 111.1}, Case{10, 20}, Case{1, 0.5}, Case{70, 1005}, Case{1e-3, 3e-3}, Case{8, 27}}) {
    for (const double dt : {1e-4, 1e-3, 1e-2}) {
      const BruteStep brute = IntegrateStep(c.omega, c.gamma, dt);
      const OscillatorStep step = CalcOscillatorStep(c.omega, c.gamma, dt);
      EXPECT_NEAR(step.keep_x, brute.keep(0, 0), 1e-12);
      EXPECT_NEAR(step.trade, brute.keep(0, 1), 1e-12);
      EXPECT_NEAR(-step.trade, brute.keep(1, 0), 1e-12);
      EXPECT_NEAR(step.keep_y, brute.keep(1, 1), 1e-12);
      EXPECT_NEAR(step.push_x_s / brute.push[0], 1, 1e-8);
      EXPECT_NEAR(step.push_y_s / brute.push[1], 1, 3e-6);
      const double xx = step.noise_x * step.noise_x + step.noise_xy * step.noise_xy;
      // the series for short steps leaves out the third order of gamma dt <= 0.01
      EXPECT_NEAR(xx / brute.noise(0, 0), 1, 3e-6) << c.omega << ' ' << dt;
      EXPECT_NEAR(step.noise_xy * step.noise_y / brute.noise(0, 1), 1, 1e-6);
      EXPECT_NEAR(step.noise_y * step.noise_y / brute.noise(1, 1), 1, 1e-6);
    }
  }
}

TEST(Turbulence, ProfilesRunThroughThePublishedAnchors) {
  const RmsProfile axis = CalcRmsProfile(0), middle = CalcRmsProfile(0.49), wall = CalcRmsProfile(1);
  EXPECT_NEAR(axis.axial, 0.85, 0.06);   // 0.8 to 0.9
  EXPECT_NEAR(axis.radial, 0.75, 0.06);  // 0.7 to 0.8
  EXPECT_EQ(axis.radial, axis.azimuthal) << "no direction across is special there";
  EXPECT_NEAR(middle.axial, 1.4, 0.05);
  EXPECT_NEAR(middle.radial, 0.9, 0.05);
  EXPECT_NEAR(middle.azimuthal, 1.1, 0.05);
  EXPECT_NEAR(wall.axial, 2.85, 0.16);  // 2.7 to 3
  EXPECT_NEAR(wall.radial, 1.1, 0.05);
  EXPECT_NEAR(wall.azimuthal, 1.5, 0.05);
  // log law of the axial variance, Hultmark et al., Phys. Rev. Lett. 108, 094501 (2012): 1.61 - 1.25 ln(y/R)
  for (const double y : {0.08, 0.1, 0.15}) {
    const double published = std::sqrt(1.61 - 1.25 * std::log(y));
    EXPECT_NEAR(CalcRmsProfile((1 - y) * (1 - y)).axial / published, 1, 0.1) << y;
  }
}

TEST(Turbulence, DissipatesNearTheWallWhatTheLogLawProduces) {
  for (const double y : {0.1, 0.15, 0.2}) {
    const double x = 1 - y, production = x / (0.4 * y);  // -<u'v'> dU/dy = u*^2 (1 - y/R) u*/(0.4 y)
    EXPECT_NEAR(CalcDissipationProfile(x * x) / production, 1, 0.12) << y;
  }
}

/// Water in a pipe of 150 mm at 1 m/s, e = 0.1 mm.
TurbulentPlace MakePlace(double offset_over_radius) {
  TurbulentPlace place;
  place.radius_m = 0.075;
  place.offset_W = {0, offset_over_radius * place.radius_m, 0};
  place.friction_velocity_m_s = 0.0501;
  return place;
}

TurbulenceCoefficients MakeCoefficients(double diameter_m, double response) {
  TurbulenceParams params;
  return CalcTurbulenceCoefficients(params, diameter_m, response);
}

TEST(Turbulence, LastsAsLongAsPublished) {
  // C0 = 5: T_L = 0.08 R/u* half way to the wall, 0.16 R/u* in the core
  const auto time = [](double x) {
    const LocalTurbulence local = CalcLocalTurbulence(MakePlace(x), MakeCoefficients(0, 1));
    return local.gamma_1_s / (local.omega_1_s * local.omega_1_s) * 0.0501 / 0.075;
  };
  EXPECT_NEAR(time(0), 0.16, 0.002);
  EXPECT_GT(time(0.5), 0.08);
  EXPECT_LT(time(0.5), 0.12);
  EXPECT_NEAR(time(0.7), 0.085, 0.01);
}

TEST(Turbulence, ABallOfTheReferenceSizeFeelsAboutHalf) {
  const TurbulenceCoefficients ball = MakeCoefficients(0.06, 1), tracer = MakeCoefficients(0, 1);
  // (0.06/0.01875)^(2/3) = 3.2^(2/3) = 2.1715: 1/sqrt(3.1715) = 0.56153
  EXPECT_NEAR(CalcSizeFilter(ball, 0.075), 0.56153, 1e-5);
  EXPECT_EQ(CalcSizeFilter(tracer, 0.075), 1);
  // T = (d^2/eps)^(1/3): eps = 0.0501^3/0.075 (1.35 + 5 0.36/0.66) = 6.836e-3, T = 0.8075 s
  const LocalTurbulence local = CalcLocalTurbulence(MakePlace(0.6), ball);
  EXPECT_NEAR(local.gamma_1_s / (local.omega_1_s * local.omega_1_s), 0.8075, 5e-4);
}

TEST(Turbulence, IsNoneInLaminarFlowAndInStillWater) {
  TurbulentPlace place = MakePlace(0.3);
  const TurbulenceCoefficients c = MakeCoefficients(0.06, 1);
  const TurbulenceState state{{1, 2, 3}, {4, 5, 6}};
  const auto expect_none = [&] {
    const LocalTurbulence local = CalcLocalTurbulence(place, c);
    EXPECT_EQ(CalcFluctuation(state, local, {1, 0, 0}).velocity_W.norm(), 0);
    EXPECT_EQ(CalcFluctuation(state, local, {1, 0, 0}).acceleration_W.norm(), 0);
    EXPECT_EQ(StepTurbulence(state, local, c, false, {1, 1, 1, 1, 1, 1}, 1e-3).xi_W, state.xi_W);
  };
  place.turbulent_fraction = 0;
  expect_none();
  place.turbulent_fraction = 1;
  place.friction_velocity_m_s = 0;
  expect_none();
}

/// S as a matrix, written down in the pipe's own directions.
Matrix3d MakeTensor(const TurbulentPlace& place, double scale) {
  const double r = place.offset_W.norm(), x2 = r * r / (place.radius_m * place.radius_m);
  const RmsProfile rms = CalcRmsProfile(x2);
  const Vector3d t = place.axis_W, out = r > 0 ? Vector3d(place.offset_W / r) : t.unitOrthogonal();
  const Vector3d round = t.cross(out);
  return scale * (rms.axial * t * t.transpose() + rms.radial * out * out.transpose() +
                  rms.azimuthal * round * round.transpose());
}

/// A bend of radius R_c about the z axis; places by the position, water turning about z.
TurbulentPlace MakeBendPlace(const Vector3d& p, double bend_radius_m) {
  TurbulentPlace place = MakePlace(0);
  const Vector3d outward = Vector3d(p.x(), p.y(), 0).normalized();
  place.axis_W = Vector3d::UnitZ().cross(outward);
  place.curvature_W = -outward / bend_radius_m;
  place.offset_W = (outward.dot(p) - bend_radius_m) * outward + Vector3d(0, 0, p.z());
  return place;
}

TEST(Turbulence, TensorDriftAndChangeAreThoseOfDifferences) {
  constexpr double kBend = 0.3, kStep = 1e-6;
  const TurbulenceCoefficients c = MakeCoefficients(0, 1);
  const Vector3d xi(0.7, -1.1, 0.4), along(0.9, 0.3, -0.2);
  for (const Vector3d& p : {Vector3d(0.33, 0.02, 0.03), Vector3d(0.3, 0, 0), Vector3d(0.25, 0.1, -0.04)}) {
    const LocalTurbulence local = CalcLocalTurbulence(MakeBendPlace(p, kBend), c);
    const auto tensor = [&](const Vector3d& at) {
      return MakeTensor(MakeBendPlace(at, kBend), local.scale_m_s);
    };
    EXPECT_LT((local.Scale(xi) - tensor(p) * xi).norm(), 1e-14);
    const Vector3d change = (tensor(p + kStep * along) - tensor(p - kStep * along)) * xi / (2 * kStep);
    EXPECT_LT((local.ScaleChange(xi, along) - change).norm(), 1e-7) << p.transpose();
    Vector3d divergence = Vector3d::Zero();
    for (int i = 0; i < 3; ++i) {
      const Vector3d d = kStep * Vector3d::Unit(i);
      divergence += (tensor(p + d) - tensor(p - d)).row(i).transpose() / (2 * kStep);
    }
    EXPECT_LT((local.drift_W_1_s - divergence).norm(), 1e-7) << p.transpose();
  }
}

TEST(Turbulence, AcceleratesOnAverageByTheDivergenceOfTheReynoldsStress) {
  // <S div S + (S xi . grad) S xi> = div(S S'): over the third-order exact set xi = +- sqrt(3) e_i
  const TurbulentPlace place = MakePlace(0.6);
  const LocalTurbulence local = CalcLocalTurbulence(place, MakeCoefficients(0, 1));
  Vector3d mean = Vector3d::Zero();
  for (int i = 0; i < 3; ++i) {
    for (const double sign : {-1.0, 1.0}) {
      const TurbulenceState state{sign * std::sqrt(3.0) * Vector3d::Unit(i), Vector3d::Zero()};
      mean += CalcFluctuation(state, local, Vector3d::Zero()).acceleration_W / 6;
    }
  }
  // d<u_r^2>/dr + (<u_r^2> - <u_th^2>)/r with s_r = 0.8476, s_th = 0.988, ds_r/dx = 0.492 at x = 0.6
  const double divergence = 2 * 0.8476 * 0.492 + (0.8476 * 0.8476 - 0.988 * 0.988) / 0.6;
  EXPECT_NEAR(mean.y() / (0.0501 * 0.0501 / 0.075 * divergence), 1, 1e-9);
  EXPECT_NEAR(mean.x(), 0, 1e-15);
}

TEST(Turbulence, StatisticsAreThoseAskedForAtAnyRateSlow) {
  // on the axis of 150 mm at u* = 0.5: T_L = 0.16 R/u* = 0.024 s, sigma = 0.8 and 0.7 u*
  TurbulentPlace place = MakePlace(0);
  place.friction_velocity_m_s = 0.5;
  const double time_s = 2 * (0.64 + 0.49 + 0.49) / 3 * 0.25 / (5 * 1.35 * 0.125 / 0.075);
  const Vector3d rms(0.4, 0.35, 0.35);
  constexpr std::int64_t kBlocks = 16000;
  for (const double rate_Hz : {1000.0, 8000.0}) {
    const TurbulenceStatistics found =
        MeasureTurbulence(place, MakeCoefficients(0, 1), Rate(rate_Hz), time_s, kBlocks, 7);
    // four standard deviations: of a variance sqrt(2 T/(whole)) = sqrt(2/(5 blocks)), of T sqrt(2/blocks)
    const double of_time = 4 * std::sqrt(2.0 / kBlocks), of_rms = 2 * std::sqrt(0.4 / kBlocks);
    for (int i = 0; i < 3; ++i) {
      EXPECT_NEAR(found.rms_m_s[i] / rms[i], 1, of_rms) << rate_Hz;
      EXPECT_NEAR(found.integral_time_s[i] / time_s, 1, of_time) << rate_Hz;
      EXPECT_NEAR(found.acceleration_m_s2[i] * time_s * 0.3 / rms[i], 1, of_rms) << rate_Hz;
    }
  }
}

double CalcChiSquare(const std::vector<std::int64_t>& counts) {
  const double expected =
      static_cast<double>(std::accumulate(counts.begin(), counts.end(), std::int64_t{0})) /
      static_cast<double>(counts.size());
  double sum = 0;
  for (const std::int64_t count : counts) {
    sum += (static_cast<double>(count) - expected) * (static_cast<double>(count) - expected) / expected;
  }
  return sum;
}

constexpr double kChiSquare9AtOnePercent = 21.666;  // nine degrees of freedom, any table

TEST(Turbulence, KeepsTracersUniformSlow) {
  // radial diffusivity s_r^2 T_L = 0.06 R u*: the slowest mode falls by exp(-3.83^2 0.06) a time unit
  EXPECT_LT(CalcChiSquare(TraceTracers(MakeCoefficients(0, 1), 12000, 10, 4, 5e-3, 3)),
            kChiSquare9AtOnePercent);
}

TEST(Turbulence, WithoutTheDriftTracersGatherSlow) {
  // towards a density of (0.7 + 0.41 x^2)^-0.524, the drift's potential: 12 % either way
  const std::vector<std::int64_t> counts = TraceTracers(MakeCoefficients(0, 0), 12000, 10, 4, 5e-3, 3);
  EXPECT_GT(CalcChiSquare(counts), kChiSquare9AtOnePercent) << "the test of uniformity can fail";
  EXPECT_GT(counts.front() + counts[1], counts[8] + counts.back());
}

/// The reference ball rolling along: mean water, gap and friction as FlowField tells them.
WaterAtBall MakeWater() {
  WaterAtBall water;
  water.velocity_W = {1, 0, 0};
  water.bulk_speed_m_s = 1;
  water.bore_radius_m = 0.075;
  water.friction_velocity_m_s = 0.0501;
  return water;
}

NetworkSpot MakeSpot() { return {0, 0, 0, {Vector3d::Zero(), Vector3d::UnitX(), Vector3d::Zero()}}; }

StreamFluctuations MakeFluctuations(bool swirl = false, std::uint64_t run = 0) {
  StreamParams params;
  params.turbulence.on = true;
  params.swirl_switching = swirl;
  return StreamFluctuations(params, 5, run, Rate(1000), 0.06, 1, 1e-6);
}

TEST(StreamFluctuations, AskingTwiceChangesNothingAndStatesAreValues) {
  const NetworkSpot spot = MakeSpot();
  const Vector3d p(0, 0, -0.045);
  StreamFluctuations a = MakeFluctuations(), b = MakeFluctuations();
  StreamFluctuations::State half;
  WaterAtBall water_a, water_b;
  for (int i = 0; i < 200; ++i) {
    a.Step();
    b.Step();
    water_a = water_b = MakeWater();
    a.AddTo(spot, p, water_a);
    WaterAtBall again = MakeWater();
    b.AddTo(spot, p, again);
    b.AddTo(spot, p, water_b);
    ASSERT_EQ(water_a.velocity_W, water_b.velocity_W);
    if (i == 99) half = a.state();
  }
  b = MakeFluctuations();
  b.Restore(half);
  for (int i = 100; i < 200; ++i) {
    b.Step();
    water_b = MakeWater();
    b.AddTo(spot, p, water_b);
  }
  EXPECT_EQ(water_a.velocity_W, water_b.velocity_W);
  EXPECT_EQ(water_a.acceleration_W, water_b.acceleration_W);
}

TEST(StreamFluctuations, SwirlChangesNoTurbulenceAndRunsDiffer) {
  const auto first = [](StreamFluctuations f) {
    WaterAtBall water = MakeWater();
    f.Step();
    f.AddTo(MakeSpot(), {0, 0, -0.045}, water);
    return water.velocity_W;
  };
  EXPECT_EQ(first(MakeFluctuations(false)), first(MakeFluctuations(true)));
  EXPECT_NE(first(MakeFluctuations(false, 0)), first(MakeFluctuations(false, 1)));
}

TEST(StreamFluctuations, SwirlSwitchesAtItsStrouhalNumber) {
  // St U/D = 0.2 1/0.15 = 1.333 Hz; a stationary Gaussian process passes zero upwards omega/(2 pi) times a
  // second (Rice 1944: sqrt(-rho''(0))/(2 pi), and rho'' = -omega^2 here)
  StreamFluctuations f = MakeFluctuations(true);
  constexpr int kSteps = 1500000;
  int upwards = 0;
  double square = 0, last = f.swirl().s, rate_error2 = 0;
  for (int i = 0; i < kSteps; ++i) {
    const Swirl before = f.swirl();
    WaterAtBall water = MakeWater();
    f.AddTo(MakeSpot(), {0, 0, -0.045}, water);
    f.Step();
    const double s = f.swirl().s;
    if (i > 0) {
      const double mean_rate = 0.5 * (before.ds_dt_1_s + f.swirl().ds_dt_1_s);
      const double missed = (s - last) / 1e-3 - mean_rate;
      rate_error2 += missed * missed;
    }
    if (last < 0 && s >= 0) ++upwards;
    square += s * s;
    last = s;
  }
  const double seconds = kSteps * 1e-3, cycles = 0.2 / 0.15 * seconds;
  // integral time gamma/omega^2 = 0.5/omega = 0.06 s, of the square about 1/gamma = 0.24 s: 1500 s hold 6000
  EXPECT_NEAR(upwards / cycles, 1, 4 / std::sqrt(cycles));
  EXPECT_NEAR(square / kSteps, 1, 4 * std::sqrt(2.0 / 6000));
  // what the trapezoid misses is a Brownian bridge: omega sqrt(gamma dt/6) = 8.378 sqrt(4.189e-3/6)
  EXPECT_NEAR(std::sqrt(rate_error2 / kSteps) / 0.22135, 1, 0.01);
}

}  // namespace
}  // namespace piperun::sim
