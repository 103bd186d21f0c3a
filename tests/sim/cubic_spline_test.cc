#include "sim/cubic_spline.h"

#include <gtest/gtest.h>

#include <cmath>

namespace piperun::sim {
namespace {

const std::vector<double> kTimes{0, 1, 2.5, 3, 5, 6, 8, 8.5, 10};
const std::vector<Vector3d> kPoints{{0, 0, 0}, {1, 0.5, 0}, {2, -1, 3}, {3, -1, 3}, {3, -1, 3},
                                    {4, 0, 1}, {4, 2, 0},   {4, 2, 0},  {0, 0, 7}};

TEST(CubicSpline, PassesThroughItsPoints) {
  const CubicSpline spline(kTimes, kPoints);
  for (std::size_t i = 0; i < kTimes.size(); ++i) {
    EXPECT_LT((spline.Eval(kTimes[i]).x - kPoints[i]).norm(), 1e-14) << i;
    EXPECT_LT((spline.Eval(std::nextafter(kTimes[i], 0)).x - kPoints[i]).norm(), 1e-13) << i;
  }
}

TEST(CubicSpline, RestFromRestOverOneIntervalIsAsDerivedByHand) {
  // knots at thirds, acceleration a triangle 0, A, -A, 0: over T = 3 from 0 to 1, A = 1; x(1) = 1/6,
  // v(1) = v(2) = 1/2, v(3/2) = 3/4, x(2) = 5/6
  const CubicSpline spline({0, 3}, {{0, 0, 0}, {1, 0, 0}});
  EXPECT_NEAR(spline.Eval(1).x.x(), 1.0 / 6, 1e-15);
  EXPECT_NEAR(spline.Eval(1).dx.x(), 0.5, 1e-15);
  EXPECT_NEAR(spline.Eval(1).ddx.x(), 1, 1e-15);
  EXPECT_NEAR(spline.Eval(1.5).dx.x(), 0.75, 1e-15);
  EXPECT_NEAR(spline.Eval(2).x.x(), 5.0 / 6, 1e-15);
  EXPECT_NEAR(spline.Eval(3).x.x(), 1, 1e-15);
}

TEST(CubicSpline, IsContinuousUpToTheSecondDerivative) {
  const CubicSpline spline(kTimes, kPoints);
  for (const double t : spline.knots_s()) {
    const SplinePoint before = spline.Eval(std::nextafter(t, -1)), after = spline.Eval(t);
    EXPECT_LT((after.x - before.x).norm(), 1e-13) << t;
    EXPECT_LT((after.dx - before.dx).norm(), 1e-13) << t;
    EXPECT_LT((after.ddx - before.ddx).norm(), 1e-12) << t;
  }
}

TEST(CubicSpline, GivesTheDerivativesOfItsValue) {
  const CubicSpline spline(kTimes, kPoints);
  const double h = 1e-5;
  for (double i = 0; i < 97; ++i) {
    const double t = 0.1031 * i + 0.01;
    const SplinePoint a = spline.Eval(t - h), b = spline.Eval(t + h), p = spline.Eval(t);
    EXPECT_LT(((b.x - a.x) / (2 * h) - p.dx).norm(), 1e-8) << t;     // j h^2 / 6 and rounding 1e-15 / h
    EXPECT_LT(((b.dx - a.dx) / (2 * h) - p.ddx).norm(), 1e-3) << t;  // one-sided where a knot lies between
  }
}

TEST(CubicSpline, StandsExactlyStillBetweenEqualPoints) {
  const CubicSpline spline(kTimes, kPoints);
  for (const double t : {3.0, 3.7, 4.999, 8.0, 8.25}) {
    const SplinePoint p = spline.Eval(t);
    EXPECT_EQ(p.dx, Vector3d(0, 0, 0)) << t;
    EXPECT_EQ(p.ddx, Vector3d(0, 0, 0)) << t;
    EXPECT_EQ(p.x, t < 6 ? kPoints[3] : kPoints[6]) << t;
  }
}

TEST(CubicSpline, BeginsAndEndsAtRest) {
  const CubicSpline spline(kTimes, kPoints);
  EXPECT_EQ(spline.Eval(0).dx, Vector3d(0, 0, 0));
  EXPECT_EQ(spline.Eval(0).ddx, Vector3d(0, 0, 0));
  for (const double t : {10.0, 12.0}) {
    EXPECT_EQ(spline.Eval(t).x, kPoints.back());
    EXPECT_EQ(spline.Eval(t).dx, Vector3d(0, 0, 0));
  }
}

TEST(CubicSpline, DoesNotOvershootAStop) {
  const CubicSpline spline(
      {0, 1, 2, 3, 4, 5, 6, 7},
      {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {3, 0, 0}, {4, 0, 0}, {5, 0, 0}, {6, 0, 0}});
  double before = 0;
  for (int i = 0; i <= 7000; ++i) {
    const double x = spline.Eval(i * 1e-3).x.x();
    EXPECT_GE(x, before - 1e-15) << i;
    if (i <= 4000) {
      EXPECT_LE(x, 3) << i;
    }
    before = x;
  }
}

TEST(CubicSpline, OfOnePointStaysThere) {
  const CubicSpline spline({0}, {{1, 2, 3}});
  EXPECT_EQ(spline.Eval(5).x, Vector3d(1, 2, 3));
  EXPECT_EQ(spline.Eval(5).dx, Vector3d(0, 0, 0));
}

}  // namespace
}  // namespace piperun::sim
