#include "sim/pipe_magnetism.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <numbers>

#include "tests/support/pipes.h"
#include "tests/support/sensor_scene.h"

namespace piperun::sim {
namespace {

using testing::FindRefusedKey;
using testing::MakeSensor;
using testing::MakeSensorContext;

const Vector3d kEarth_W_T(2.6e-6, 25.1e-6, -40.4e-6);
const Vector3d kEast = Vector3d::UnitX();

/// The transverse field from the conditions at both walls: potentials -h_1 r cos in the bore, (c r + d / r)
/// cos in the wall, (-r + e / r) cos outside; potential and mu dphi/dr continuous.
double SolveShielding(double mu, double a, double b) {
  Eigen::Matrix4d A;
  A << -a, -a, -1 / a, 0,        //
      0, b, 1 / b, -1 / b,       //
      -1, -mu, mu / (a * a), 0,  //
      0, mu, -mu / (b * b), 1 / (b * b);
  return A.partialPivLu().solve(Eigen::Vector4d(0, -b, 0, -1))[0];
}

TEST(PipeShield, SolvesTheConditionsAtBothWalls) {
  for (const double mu : {1.0, 1.5, 20.0, 300.0, 5000.0}) {
    for (const double b : {0.076, 0.082, 0.15}) {
      const double solved = SolveShielding(mu, 0.075, b);
      EXPECT_NEAR(CalcTransverseShielding(mu, 0.075, b) / solved, 1, 1e-11) << mu << " " << b;
    }
  }
}

TEST(PipeShield, OfAThinTubeIsThatOfTheHandbooks) {
  // mu >> 1, t << D: 1 / S = 1 + mu t / D (Mager, IEEE Trans. Magn. 6, 67, 1970)
  const double mu = 8000, D = 0.5, t = 0.0005;
  EXPECT_NEAR(CalcTransverseShielding(mu, 0.5 * (D - t), 0.5 * (D + t)) * (1 + mu * t / D), 1, 3 * t / D);
}

TEST(PipeShield, LetsTheFieldAlongTheAxisPass) {
  const Vector3d axis = Vector3d(1, 2, -2) / 3;
  const Vector3d inside = CalcFieldInTube(kEarth_W_T, axis, 0.1);
  EXPECT_NEAR(inside.dot(axis), kEarth_W_T.dot(axis), 1e-20);
  EXPECT_LT((inside.cross(axis) - 0.1 * kEarth_W_T.cross(axis)).norm(), 1e-20);
}

/// 1 km of pipe to the east.
Network MakeMain(double relative_permeability, double length_m = 1000) {
  PipeSpec pipe = testing::MakePipeSpec("MAIN", "A", "B");
  pipe.material.relative_permeability = relative_permeability;
  return Network({{"A", {0, 0, 0}}, {"B", {length_m, 0, 0}}}, {pipe});
}

PipeMagnetismParams Joints(double amplitude_T, double spacing_m) {
  PipeMagnetismParams params;
  params.joint_amplitude_T = amplitude_T;
  params.joint_spacing_m = spacing_m;
  return params;
}

Vector3d Anomaly_T(const PipeMagnetism& magnetism, double s_m) {
  return magnetism.CalcField_W_T(kEarth_W_T, 0, s_m, kEast) - kEarth_W_T;
}

TEST(JointAnomaly, IsABellAroundEveryJointOfAMagneticPipe) {
  const Network iron = MakeMain(300);
  PipeMagnetismParams params = Joints(20e-6, 6);
  params.joint_width_m = 0.15;
  const PipeMagnetism magnetism(params, {&iron, {}, 7, 0});
  for (int k = 1; k < 160; ++k) {
    const Vector3d peak = Anomaly_T(magnetism, 6 * k);
    EXPECT_NEAR(peak.norm(), 20e-6, 1e-16);
    EXPECT_LT((Anomaly_T(magnetism, 6 * k + 0.15) - std::exp(-0.5) * peak).norm(), 1e-16);
    EXPECT_LT((Anomaly_T(magnetism, 6 * k - 0.3) - std::exp(-2) * peak).norm(), 1e-16);
    EXPECT_LT(Anomaly_T(magnetism, 6 * k + 3).norm(), 1e-20);
  }
}

TEST(JointAnomaly, PointsAnywhereWithTheScatterItIsGiven) {
  const Network iron = MakeMain(300, 30'000);
  PipeMagnetismParams params = Joints(20e-6, 5);
  params.joint_amplitude_sd_T = 4e-6;
  const PipeMagnetism magnetism(params, {&iron, {}, 7, 0});
  const int n = 5999;
  Vector3d mean = Vector3d::Zero();
  Matrix3d spread = Matrix3d::Zero();
  double size = 0, squares = 0;
  for (int k = 1; k <= n; ++k) {
    const Vector3d b = Anomaly_T(magnetism, 5 * k);
    mean += b.normalized() / n;
    spread += b.normalized() * b.normalized().transpose() / n;
    size += b.norm() / n;  // 5 sigma from zero: never negative here in a way that matters
    squares += b.squaredNorm() / n;
  }
  // even on the sphere: each component has variance 1/3, its square 4/45
  EXPECT_LT(mean.cwiseAbs().maxCoeff(), 4.5 * std::sqrt(1.0 / 3 / n));
  EXPECT_LT((spread - Matrix3d::Identity() / 3).diagonal().cwiseAbs().maxCoeff(),
            4.5 * std::sqrt(4.0 / 45 / n));
  EXPECT_NEAR(size, 20e-6, 4.5 * 4e-6 / std::sqrt(n));
  EXPECT_NEAR(std::sqrt(squares - size * size), 4e-6, 4.5 * 4e-6 / std::sqrt(2.0 * n));
}

TEST(JointAnomaly, StandsWhereTheWallFeaturesStand) {
  const Network iron = MakeMain(300);
  PipeMagnetismParams params;
  params.joint_amplitude_T = 1e-5;
  const StickJoint joints[] = {{0, 40.5}, {0, 12.25}};
  const PipeMagnetism magnetism(params, {&iron, joints, 7, 0});
  EXPECT_NEAR(Anomaly_T(magnetism, 12.25).norm(), 1e-5, 1e-16);
  EXPECT_NEAR(Anomaly_T(magnetism, 40.5).norm(), 1e-5, 1e-16);
  EXPECT_EQ(Anomaly_T(magnetism, 30).norm(), 0);
}

TEST(PipeMagnetism, LeavesPipesThatAreNotMagneticAndTheOpenAirAlone) {
  const Network pvc = MakeMain(1);
  PipeMagnetismParams params;
  params.shield = true;
  const PipeMagnetism magnetism(params, {&pvc, {}, 7, 0});
  EXPECT_EQ(magnetism.CalcField_W_T(kEarth_W_T, 0, 12, kEast), kEarth_W_T);
  EXPECT_EQ(magnetism.CalcField_W_T(kEarth_W_T, -1, 0, kEast), kEarth_W_T);
}

TEST(PipeMagnetism, RefusesWhatHasNoPlace) {
  const Network pvc = MakeMain(1), iron = MakeMain(300);
  PipeMagnetismParams shield;
  shield.shield = true;
  EXPECT_EQ(FindRefusedKey([&] { PipeMagnetism(shield, {}); }), "shield");
  EXPECT_EQ(FindRefusedKey([&] { PipeMagnetism(Joints(1e-6, 6), {}); }), "joint_amplitude_T");
  EXPECT_EQ(FindRefusedKey([&] { PipeMagnetism(Joints(1e-6, 6), {&pvc, {}, 7, 0}); }), "joint_spacing_m");
  PipeMagnetismParams nowhere;
  nowhere.joint_amplitude_T = 1e-6;
  EXPECT_EQ(FindRefusedKey([&] { PipeMagnetism(nowhere, {&iron, {}, 7, 0}); }), "joint_spacing_m");
  EXPECT_EQ(FindRefusedKey([&] { MakeSensor("magnetometer", {{"pipe.shield", true}}); }), "pipe.shield");
}

Vector3d Read_T(Sensor& sensor, std::int64_t k, const TruthWindow& window) {
  return std::get<MagSample>(sensor.Sample(k, window)).m_S_T;
}

TEST(Magnetometer, InAnIronPipeSeesTheFieldAlongItAndLittleElse) {
  const Network iron = MakeMain(300);
  SensorContext context = MakeSensorContext();
  context.network = &iron;
  const auto sensor = MakeSensor("magnetometer", {{"rate_Hz", 100.0}, {"pipe.shield", true}}, context);
  // rolls east: spins about y
  const auto window = testing::MakeWindow(500, [](TruthState& s) {
    s.pipe = 0;
    s.s_m = 500 + 0.5 * Seconds(s.time);
    s.X_WB.q = ExpSO3({0, 20 * Seconds(s.time), 0});
  });
  const double S = SolveShielding(300, 0.075, 0.082);
  EXPECT_LT(S, 0.1);
  for (std::int64_t k = 0; k < 50; ++k) {
    const Vector3d m_W_T = ExpSO3({0, 0.2 * static_cast<double>(k), 0}) * Read_T(*sensor, k, window);
    EXPECT_LT((m_W_T - Vector3d(2.6e-6, S * 25.1e-6, -S * 40.4e-6)).norm(), 1e-17);
  }
}

TEST(Magnetometer, SharesItsPipeWithOthersAndGetsAnotherOneInAnotherRun) {
  const Network iron = MakeMain(300);
  const auto window = testing::MakeWindow(2, [](TruthState& s) {
    s.pipe = 0;
    s.s_m = 12;
  });
  const auto read = [&](std::uint64_t run, std::string_view channel) {
    SensorContext context = MakeSensorContext(run, channel);
    context.network = &iron;
    const auto sensor = MakeSensor(
        "magnetometer", {{"pipe.joint_amplitude_T", 2e-5}, {"pipe.joint_spacing_m", 6.0}}, context);
    return Read_T(*sensor, 0, window);
  };
  EXPECT_EQ(read(0, "mag0"), read(0, "mag1"));
  EXPECT_GT((read(0, "mag0") - read(1, "mag0")).norm(), 1e-7);
}

TEST(Magnetometer, DrawsBiasScaleAndMisalignmentOncePerRun) {
  const auto window = testing::MakeWindow(20, [](TruthState&) {});
  const int runs = 4000;
  double bias = 0, diagonal = 0, across = 0;
  for (std::uint64_t run = 0; run < runs; ++run) {
    const auto sensor = [&](const std::vector<double>& field_W_T) {
      return MakeSensor("magnetometer",
                        {{"field_W_T", field_W_T},
                         {"bias_sd_T", 2e-6},
                         {"scale_error_sd", 0.01},
                         {"misalignment_sd", 0.004}},
                        MakeSensorContext(run));
    };
    const auto none = sensor({0, 0, 0}), east = sensor({1, 0, 0});
    const Vector3d b = Read_T(*none, 0, window), column = Read_T(*east, 0, window) - b;
    EXPECT_EQ(Read_T(*none, 1, window), b);
    bias += b.squaredNorm() / 3 / runs;
    diagonal += (column.x() - 1) * (column.x() - 1) / runs;
    across += (column.y() * column.y() + column.z() * column.z()) / 2 / runs;
  }
  EXPECT_NEAR(bias / 4e-12, 1, 4.5 * std::sqrt(2.0 / (3 * runs)));
  EXPECT_NEAR(diagonal / 1e-4, 1, 4.5 * std::sqrt(2.0 / runs));
  EXPECT_NEAR(across / 1.6e-5, 1, 4.5 * std::sqrt(2.0 / (2 * runs)));
}

TEST(Magnetometer, DriftsByItsBiasInstability) {
  // eight processes of variance B^2 ln 10 / pi each, stationary from the start
  const auto window = testing::MakeWindow(20, [](TruthState&) {});
  const int runs = 4000;
  double squares = 0;
  for (std::uint64_t run = 0; run < runs; ++run) {
    const auto sensor = MakeSensor(
        "magnetometer", {{"field_W_T", std::vector<double>{0, 0, 0}}, {"bias_instability_T", 1e-8}},
        MakeSensorContext(run));
    squares += Read_T(*sensor, 0, window).squaredNorm() / 3 / runs;
  }
  EXPECT_NEAR(squares / (8 * 1e-16 * std::log(10.0) / std::numbers::pi), 1,
              4.5 * std::sqrt(2.0 / (3 * runs)));
}

}  // namespace
}  // namespace piperun::sim
