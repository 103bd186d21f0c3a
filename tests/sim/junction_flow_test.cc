#include "sim/junction_flow.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <vector>

#include "base/random.h"
#include "tests/support/star.h"

namespace piperun::sim {
namespace {

using std::numbers::pi;
using testing::MakeStar;
using testing::Ray;

constexpr double kR = 0.5, kA = pi * kR * kR;

/// A joint with its flow; lengths as FlowField chooses them.
struct Fitting {
  explicit Fitting(const std::vector<Ray>& rays)
      : network(MakeStar(rays)), bore(network), core_m(MakeCores()), flow(bore.joint(0), core_m) {}

  std::vector<double> MakeCores() const {
    std::vector<double> cores;
    for (const JointArm& arm : bore.joint(0).arms) cores.push_back(arm.reach_m + 2.5 * arm.radius_m);
    return cores;
  }
  Vector3d Velocity(const std::vector<double>& outflow, std::size_t arm, const Vector3d& p) const {
    return flow.Eval(outflow, arm, p).velocity_m_s;
  }

  Network network;
  Bore bore;
  std::vector<double> core_m;
  JunctionFlow flow;
};

const Vector3d kX = Vector3d::UnitX(), kY = Vector3d::UnitY(), kZ = Vector3d::UnitZ();
const std::vector<Ray> kTee{{-kX}, {kX}, {kY}};
const std::vector<Ray> kWye{{-kX}, {{0.5, std::sqrt(0.75), 0}}, {{0.5, -std::sqrt(0.75), 0}}};

/// Largest relative difference between the flow through an arm's section, by quadrature over the disc, and
/// the one asked for.
double FluxError(const Fitting& fitting, const std::vector<double>& outflow, std::size_t arm, double z) {
  const Vector3d axis = fitting.bore.joint(0).arms[arm].outward, e1 = axis.unitOrthogonal();
  const double radius = fitting.bore.joint(0).arms[arm].radius_m;
  // midpoints in r^2 and in the angle would be of second order; Gauss in r is exact to the 15th degree
  constexpr std::array<double, 4> kNode{0.1834346424956498, 0.525532409916329, 0.7966664774136267,
                                        0.9602898564975363};
  constexpr std::array<double, 4> kWeight{0.362683783378362, 0.3137066458778873, 0.2223810344533745,
                                          0.1012285362903763};
  double flux = 0;
  for (std::size_t k = 0; k < 8; ++k) {
    const double node = (k < 4 ? -1 : 1) * kNode[k % 4], r = radius * 0.5 * (1 + node);
    for (int j = 0; j < 64; ++j) {
      const double angle = 2 * pi * j / 64;
      const Vector3d out = std::cos(angle) * e1 + std::sin(angle) * axis.cross(e1);
      const Vector3d u = fitting.Velocity(outflow, arm, z * axis + r * out);
      flux += u.dot(axis) * r * 0.5 * radius * kWeight[k % 4] * 2 * pi / 64;
    }
  }
  return std::abs(flux - outflow[arm]);
}

struct Case {
  const char* name;
  std::vector<Ray> rays;
  double wall_rms;  ///< allowed
};

class Fittings : public ::testing::TestWithParam<Case> {};

TEST_P(Fittings, AreTangentToTheirWalls) {
  const Fitting fitting(GetParam().rays);
  const JunctionFit& fit = fitting.flow.fit();
  std::printf("%-11s %4d sources, %4d wall points: normal velocity rms %.3f, max %.2f\n", GetParam().name,
              fit.sources, fit.wall_points, fit.wall_rms, fit.wall_max);
  EXPECT_LT(fit.wall_rms, GetParam().wall_rms);
  EXPECT_LT(fit.wall_max, 1);
}

TEST_P(Fittings, CarryTheGivenFlowThroughEverySection) {
  const Fitting fitting(GetParam().rays);
  std::vector<double> outflow(GetParam().rays.size(), 0.3 * kA);
  outflow[0] = -kA;
  for (std::size_t arm = 0; arm < outflow.size(); ++arm) {
    EXPECT_LT(FluxError(fitting, outflow, arm, fitting.core_m[arm]), 1e-6 * kA) << arm;
  }
}

TEST_P(Fittings, AreDivergenceFreeWithTheirOwnGradient) {
  const Fitting fitting(GetParam().rays);
  std::vector<double> outflow(GetParam().rays.size(), -0.4 * kA);
  outflow[0] = kA;
  for (std::size_t arm = 0; arm < outflow.size(); ++arm) {
    const Vector3d axis = fitting.bore.joint(0).arms[arm].outward, e1 = axis.unitOrthogonal();
    const double radius = fitting.bore.joint(0).arms[arm].radius_m;
    for (int k = 0; k < 40; ++k) {
      const double z = fitting.core_m[arm] * (k + 0.5) / 40, r = radius * 0.15 * (k % 5);
      const Vector3d p = z * axis + r * (std::cos(k) * e1 + std::sin(k) * axis.cross(e1));
      Matrix3d slope;
      constexpr double kStep = 1e-5;
      for (int j = 0; j < 3; ++j) {
        const Vector3d d = kStep * Vector3d::Unit(j);
        slope.col(j) =
            (fitting.Velocity(outflow, arm, p + d) - fitting.Velocity(outflow, arm, p - d)) / (2 * kStep);
      }
      EXPECT_NEAR(slope.trace(), 0, 1e-6 / kR) << "arm " << arm << " z " << z;
      const Matrix3d gradient = fitting.flow.Eval(outflow, arm, p).gradient_1_s;
      EXPECT_LT((gradient - slope).norm(), 2e-6 / kR) << "arm " << arm << " z " << z;
    }
  }
}

TEST_P(Fittings, GoOverContinuouslyIntoUniformFlow) {
  const Fitting fitting(GetParam().rays);
  std::vector<double> outflow(GetParam().rays.size(), 0.5 * kA);
  outflow[0] = -kA;
  for (std::size_t arm = 0; arm < outflow.size(); ++arm) {
    const JointArm& at = fitting.bore.joint(0).arms[arm];
    const double uniform = outflow[arm] / (pi * at.radius_m * at.radius_m);
    const Vector3d off_axis = 0.5 * at.radius_m * at.outward.unitOrthogonal();
    for (const double z : {fitting.flow.fade_begin_m(arm), fitting.core_m[arm]}) {
      const Vector3d before = fitting.Velocity(outflow, arm, (z - 1e-9) * at.outward + off_axis);
      const Vector3d after = fitting.Velocity(outflow, arm, (z + 1e-9) * at.outward + off_axis);
      EXPECT_LT((after - before).norm(), 1e-6 * std::abs(uniform));
    }
    const Vector3d end = fitting.Velocity(outflow, arm, fitting.core_m[arm] * at.outward + off_axis);
    EXPECT_LT((end - uniform * at.outward).norm(), 1e-9 * std::abs(uniform));
  }
}

// right angles and wider: a few per cent of the mean speed, next to the rounded lips; in a lateral the worst
// flow is that from its branch back along the run, by 135 degrees round the sharp crotch
INSTANTIATE_TEST_SUITE_P(
    Joints, Fittings,
    ::testing::Values(Case{"Tee", kTee, 0.04}, Case{"Wye", kWye, 0.03},
                      Case{"ReducedTee", {{-kX}, {kX}, {kY, 0.5}}, 0.04},
                      Case{"Cross", {{-kX}, {kX}, {kY}, {-kY}}, 0.04}, Case{"Mitre", {{-kX}, {kY}}, 0.05},
                      Case{"Step", {{-kX}, {kX, 0.6}}, 0.03},
                      Case{"Lateral", {{-kX}, {kX}, {{1, 1, 0}}}, 0.13},
                      Case{"Riser", {{-kX}, {kX}, {kZ, 0.7}, {{0.3, 1, 0.2}, 0.8}}, 0.05}),
    [](const auto& info) { return info.param.name; });

TEST(JunctionFlow, OfASymmetricYIsSymmetric) {
  const Fitting fitting(kWye);
  const std::vector<double> outflow{-2 * kA, kA, kA};
  for (const Vector3d& p : {Vector3d(-0.2, 0.1, 0.1), Vector3d(0.1, 0.3, -0.2), Vector3d(0.3, 0.05, 0)}) {
    const Vector3d mirrored(p.x(), -p.y(), p.z());
    const Vector3d u = fitting.Velocity(outflow, 0, p), v = fitting.Velocity(outflow, 0, mirrored);
    EXPECT_LT((Vector3d(u.x(), -u.y(), u.z()) - v).norm(), 1e-3 * u.norm());  // 2e-4: sources are not quite
  }
}

TEST(JunctionFlow, OfAClosedBranchAsWideAsTheMainDipsIntoIt) {
  const Fitting fitting(kTee);
  const std::vector<double> outflow{-kA, kA, 0};
  for (double x = -1.5; x <= 1.5; x += 0.1) {
    const Vector3d u = fitting.Velocity(outflow, x < 0 ? 0 : 1, {x, 0, 0});
    EXPECT_GT(u.x(), 0.7) << x;  // the opening widens the way by as much as the flow dips into it
    EXPECT_LT(u.x(), 1.01) << x;
    EXPECT_LT(std::hypot(u.y(), u.z()), 0.15) << x;
  }
  // behind the rounded lip it dies away like the slowest mode, cosh(1.841 (L - z)/R) before a section at L =
  // 3.5 R without flow through it: by cosh(2.95)/cosh(1.66) = 3.5 from 1.9 R to 2.6 R
  const double near = fitting.Velocity(outflow, 0, {0, 1.9 * kR, 0}).norm();
  const double far = fitting.Velocity(outflow, 0, {0, 2.6 * kR, 0}).norm();
  EXPECT_GT(near, 0.1);
  EXPECT_NEAR(near / far, 3.5, 0.7);
  EXPECT_LT(fitting.Velocity(outflow, 2, {0, 0.999 * fitting.core_m[2], 0}).norm(), 1e-6);
}

TEST(JunctionFlow, OfANarrowClosedBranchLeavesTheAxisAlone) {
  const Fitting fitting({{-kX}, {kX}, {kY, 0.3}});
  for (double x = -1; x <= 1; x += 0.1) {
    const Vector3d u = fitting.Velocity({-kA, kA, 0}, x < 0 ? 0 : 1, {x, 0, 0});
    EXPECT_LT((u - kX).norm(), 0.03) << x;
  }
}

/// Seeds spread evenly over the section far upstream of a tee, carried until they leave: the share that
/// leaves by the branch. Fourth-order Runge-Kutta.
double TraceBranchShare(const Fitting& fitting, const std::vector<double>& outflow) {
  int seeds = 0, branched = 0;
  constexpr int kCells = 24;
  for (int i = 0; i < kCells; ++i) {
    for (int j = 0; j < kCells; ++j) {
      Vector3d p(-fitting.core_m[0], kR * (2 * (i + 0.5) / kCells - 1), kR * (2 * (j + 0.5) / kCells - 1));
      if (std::hypot(p.y(), p.z()) > kR) continue;
      ++seeds;
      const auto velocity = [&](const Vector3d& at) {
        return fitting.Velocity(outflow, at.y() > kR ? 2 : at.x() < 0 ? 0 : 1, at);
      };
      for (int k = 0; k < 2000 && p.y() < 1.5 * kR && p.x() < 2 * kR; ++k) {
        constexpr double kDt = 0.02;
        const Vector3d k1 = velocity(p), k2 = velocity(p + 0.5 * kDt * k1);
        const Vector3d k3 = velocity(p + 0.5 * kDt * k2), k4 = velocity(p + kDt * k3);
        p += kDt / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
      }
      if (p.y() >= 1.5 * kR) ++branched;
    }
  }
  return static_cast<double>(branched) / seeds;
}

TEST(JunctionFlow, DividesParticlesLikeTheFlowSlow) {
  const Fitting fitting(kTee);
  for (const double share : {0.25, 0.5, 0.75}) {
    EXPECT_NEAR(TraceBranchShare(fitting, {-kA, (1 - share) * kA, share * kA}), share, 0.02);
  }
}

TEST(JunctionFlow, WithoutFlowIsAtRest) {
  const Fitting fitting(kTee);
  EXPECT_EQ(fitting.Velocity({0, 0, 0}, 0, {0.1, 0.2, 0.1}).norm(), 0);
  EXPECT_EQ(fitting.Velocity({0, 0, 0}, 2, {0, fitting.core_m[2] - 0.1, 0.1}).norm(), 0);
}

TEST(JunctionFlow, TurnsRoundWithTheFlow) {
  const Fitting fitting(kTee);
  const Vector3d p(0.1, 0.3, 0.1);
  const Vector3d u = fitting.Velocity({-kA, 0.4 * kA, 0.6 * kA}, 0, p);
  EXPECT_LT((u + fitting.Velocity({kA, -0.4 * kA, -0.6 * kA}, 0, p)).norm(), 1e-12);
}

TEST(JunctionFlow, TakesAWithdrawalThroughItsWall) {
  // what flows in by one arm and out by none: on the axis the speed falls in proportion to the wall passed
  const Fitting fitting({{-kX}, {kY}});
  const std::vector<double> outflow{-kA, 0};
  EXPECT_LT(FluxError(fitting, outflow, 0, fitting.core_m[0]), 1e-6 * kA);
  EXPECT_LT(FluxError(fitting, outflow, 1, fitting.core_m[1]), 1e-6 * kA);
  EXPECT_GT(fitting.Velocity(outflow, 1, {0, 1, 0}).y(), 0.05);
}

TEST(JunctionFlow, DoesNotCoverParallelArms) {
  const Network network = MakeStar({{-kX}, {kX}, {{1, 0.1, 0}}});
  EXPECT_FALSE(JunctionFlow::Covers(Bore(network).joint(0)));
  EXPECT_TRUE(JunctionFlow::Covers(Bore(MakeStar(kTee)).joint(0)));
}

TEST(JunctionFlow, OfArbitraryJointsIsBoundedSlow) {
  // two to five arms anywhere, bores 1 to 3: where a ball's centre can be the water is nowhere much faster
  // than in the fastest arm
  const RandomStream random(7, "joints", 0);
  int covered = 0;
  for (std::uint64_t n = 0; n < 20; ++n) {
    std::vector<Ray> rays;
    for (std::uint64_t i = 0; i < 2 + n % 4; ++i) {
      const auto draw = random.Normals(n, static_cast<std::uint32_t>(i));
      rays.push_back({{draw[0], draw[1], 0.4 * draw[2]}, 2 - std::tanh(draw[3])});
    }
    const Network network = MakeStar(rays);
    if (!JunctionFlow::Covers(Bore(network).joint(0))) continue;
    ++covered;
    const Fitting fitting(rays);
    std::vector<double> outflow(rays.size(), 0.5);
    outflow[0] = -1;
    double fastest = 0;
    for (const Pipe& pipe : network.pipes()) fastest = std::max(fastest, 1 / pipe.area_m2());
    for (std::size_t arm = 0; arm < rays.size(); ++arm) {
      const JointArm& at = fitting.bore.joint(0).arms[arm];
      const Vector3d across = at.outward.unitOrthogonal();
      for (int k = 0; k < 60; ++k) {
        const Vector3d out = std::cos(k) * across + std::sin(k) * at.outward.cross(across);
        const Vector3d p = fitting.core_m[arm] * k / 60 * at.outward + 0.12 * (k % 7) * at.radius_m * out;
        EXPECT_LT(fitting.Velocity(outflow, arm, p).norm(), 2 * fastest) << "joint " << n;
      }
    }
  }
  EXPECT_GT(covered, 10);
}

}  // namespace
}  // namespace piperun::sim
