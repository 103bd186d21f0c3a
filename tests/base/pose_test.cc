#include "base/pose.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/any.h"

namespace piperun {
namespace {

constexpr double kPi = std::numbers::pi;

/// Rodrigues' formula: R = I + sin(a)/a [t] + (1 - cos a)/a^2 [t]^2, written apart from the quaternion's.
Matrix3d Rodrigues(const Vector3d& theta) {
  const double a = theta.norm();
  if (a == 0) return Matrix3d::Identity();
  const Matrix3d k = Skew(theta / a);
  return Matrix3d::Identity() + std::sin(a) * k + (1 - std::cos(a)) * k * k;
}

RC_GTEST_PROP(Skew, IsTheCrossProduct, ()) {
  const Vector3d a = any::Vector(10), b = any::Vector(10);
  RC_ASSERT((Skew(a) * b - a.cross(b)).norm() <= 1e-13);
  RC_ASSERT(Skew(a).transpose() == -Skew(a));
}

TEST(ExpSO3, AQuarterTurnAboutZTakesXToY) {
  const Vector3d y = ExpSO3({0, 0, kPi / 2}) * Vector3d::UnitX();
  EXPECT_NEAR((y - Vector3d::UnitY()).norm(), 0, 1e-15);
}

RC_GTEST_PROP(ExpSO3, EqualsRodriguesFormulaAndIsAUnitQuaternion, ()) {
  const Vector3d theta = any::Vector(20);
  const Quaterniond q = ExpSO3(theta);
  RC_ASSERT(std::abs(q.norm() - 1) <= 4e-16);
  RC_ASSERT((q.toRotationMatrix() - Rodrigues(theta)).norm() <= 2e-14);
}

// the change from series to sine at 1e-4 rad must not show
TEST(ExpSO3, IsSmoothWhereTheSeriesEnds) {
  for (const double angle : {9.9999e-5, 1.00001e-4}) {
    const Quaterniond q = ExpSO3({angle, 0, 0});
    EXPECT_NEAR(q.x() / std::sin(0.5 * angle), 1, 3e-16);
  }
  EXPECT_EQ(ExpSO3(Vector3d::Zero()).w(), 1);
}

// drawn on a logarithmic scale from 1e-12 rad to nearly half a turn
RC_GTEST_PROP(LogSO3, InvertsExpBelowHalfATurn, ()) {
  const Vector3d axis = any::Vector(1);
  RC_PRE(axis.norm() > 1e-3);
  const double angle = 3.14159 * std::exp(-27.0 * any::Between(0, 1));
  const Vector3d theta = angle * axis.normalized();
  RC_ASSERT((LogSO3(ExpSO3(theta)) - theta).norm() <= 5e-16 * (1 + angle) * angle + 5e-16 * angle);
}

RC_GTEST_PROP(LogSO3, TakesTheShorterWayRound, ()) {
  const Vector3d theta = any::Vector(20);
  const Vector3d back = LogSO3(ExpSO3(theta));
  RC_ASSERT(back.norm() <= kPi + 1e-15);
  RC_ASSERT((Rodrigues(back) - Rodrigues(theta)).norm() <= 1e-13);
}

TEST(LogSO3, DoesNotCareForTheSignOfTheQuaternion) {
  const Quaterniond q = ExpSO3({0.3, -0.2, 0.5});
  EXPECT_EQ(LogSO3(q), LogSO3(Quaterniond(-q.w(), -q.x(), -q.y(), -q.z())));
  EXPECT_NEAR((LogSO3(q) - Vector3d(0.3, -0.2, 0.5)).norm(), 0, 1e-15);
}

TEST(LogSO3, HalfATurnHasLengthPi) { EXPECT_DOUBLE_EQ(LogSO3(Quaterniond(0, 0, 1, 0)).norm(), kPi); }

RC_GTEST_PROP(Pose, ComposesInversesAndMapsLikeAHomogeneousMatrix, ()) {
  const Pose X_WB{any::Vector(100), ExpSO3(any::Vector(3))};
  const Pose X_BS{any::Vector(1), ExpSO3(any::Vector(3))};
  const Vector3d p_S = any::Vector(1);
  const Vector3d expected = Rodrigues(LogSO3(X_WB.q)) * (Rodrigues(LogSO3(X_BS.q)) * p_S + X_BS.p) + X_WB.p;
  RC_ASSERT(((X_WB * X_BS) * p_S - expected).norm() <= 1e-12);
  RC_ASSERT((X_WB.Inverse() * (X_WB * p_S) - p_S).norm() <= 1e-12);
  RC_ASSERT((X_WB * X_WB.Inverse()).p.norm() <= 1e-12);
}

}  // namespace
}  // namespace piperun
