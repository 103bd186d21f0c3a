#include "sim/drag.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

namespace piperun::sim {
namespace {

constexpr std::array<DragLaw, 6> kAll{DragLaw::kBrownLawler,     DragLaw::kCliftGauvin,
                                      DragLaw::kCliftGauvin1970, DragLaw::kCliftGraceWeber,
                                      DragLaw::kMorrison,        DragLaw::kBaratiHigh};

class EveryDragLaw : public ::testing::TestWithParam<DragLaw> {};
INSTANTIATE_TEST_SUITE_P(All, EveryDragLaw, ::testing::ValuesIn(kAll),
                         [](const auto& law) { return std::string(FindDragLaw(law.param).key); });

TEST(Drag, LawsMatchTheirTable) {
  // values of independent implementations, rounded to as many decimals as printed; a tolerance of 1e-4
  // holds the last one
  struct Row {
    double re, clift_grace_weber, clift_gauvin, brown_lawler, morrison, barati_high;
  };
  constexpr double kNone = 0;
  constexpr Row kTable[] = {
      {10, 4.2584, 4.1347, 4.1275, 3.9676, 4.3638},  {100, 1.0870, 1.0704, 1.0731, 1.0382, 1.0737},
      {1e3, 0.4711, 0.4639, 0.4634, 0.4841, 0.4649}, {1e4, 0.4052, 0.4103, 0.4106, 0.3936, 0.4109},
      {1e5, 0.5018, 0.4675, 0.4661, 0.4247, 0.4670}, {2e5, 0.4977, 0.4670, 0.4635, 0.4120, 0.4730},
      {3e5, 0.4808, 0.4647, 0.4600, 0.1680, 0.1796}, {4e5, 0.0702, kNone, kNone, 0.0874, 0.0901},
      {1e6, 0.1100, kNone, kNone, 0.1415, 0.2125}};
  for (const Row& row : kTable) {
    EXPECT_NEAR(CalcDragCoefficient(DragLaw::kCliftGraceWeber, row.re), row.clift_grace_weber, 1e-4)
        << row.re;
    EXPECT_NEAR(CalcDragCoefficient(DragLaw::kMorrison, row.re), row.morrison, 1e-4) << row.re;
    EXPECT_NEAR(CalcDragCoefficient(DragLaw::kBaratiHigh, row.re), row.barati_high, 1e-4) << row.re;
    if (row.clift_gauvin == kNone) continue;
    EXPECT_NEAR(CalcDragCoefficient(DragLaw::kCliftGauvin, row.re), row.clift_gauvin, 1e-4) << row.re;
    EXPECT_NEAR(CalcDragCoefficient(DragLaw::kBrownLawler, row.re), row.brown_lawler, 1e-4) << row.re;
  }
  constexpr double kThreeDecimals = 5.1e-4;  // the row at Re = 1 is printed with three
  EXPECT_NEAR(CalcDragCoefficient(DragLaw::kCliftGraceWeber, 1), 27.156, kThreeDecimals);
  EXPECT_NEAR(CalcDragCoefficient(DragLaw::kCliftGauvin, 1), 27.648, kThreeDecimals);
  EXPECT_NEAR(CalcDragCoefficient(DragLaw::kBrownLawler, 1), 27.600, kThreeDecimals);
  EXPECT_NEAR(CalcDragCoefficient(DragLaw::kMorrison, 1), 24.673, kThreeDecimals);
  EXPECT_NEAR(CalcDragCoefficient(DragLaw::kBaratiHigh, 1), 26.501, kThreeDecimals);
}

TEST(Drag, FormulasAreThePrintedOnes) {
  for (double re = 0.02; re < 1e6; re *= 1.3) {
    const auto expect = [&](DragLaw law, double printed) {
      EXPECT_NEAR(CalcDragCoefficient(law, re) / printed, 1, 1e-12) << FindDragLaw(law).key << " " << re;
    };
    expect(DragLaw::kBrownLawler, 24 / re * (1 + 0.15 * std::pow(re, 0.681)) + 0.407 / (1 + 8710 / re));
    expect(DragLaw::kCliftGauvin,
           24 / re * (1 + 0.152 * std::pow(re, 0.677)) + 0.417 / (1 + 5070 * std::pow(re, -0.94)));
    expect(DragLaw::kCliftGauvin1970,
           24 / re * (1 + 0.15 * std::pow(re, 0.687)) + 0.42 / (1 + 42500 * std::pow(re, -1.16)));
    const double x = re / 263000;
    expect(DragLaw::kMorrison, 24 / re + 2.6 * (re / 5) / (1 + std::pow(re / 5, 1.52)) +
                                   0.411 * std::pow(x, -7.94) / (1 + std::pow(x, -8)) +
                                   std::pow(re, 0.8) / 461000);
  }
}

TEST(Drag, BaratisFormulaGivesItsAuthorsExample) {
  EXPECT_NEAR(CalcDragCoefficient(DragLaw::kBaratiHigh, 200), 0.7730544082789523, 1e-12);
  EXPECT_NEAR(CalcDragCoefficient(DragLaw::kMorrison, 200), 0.767731559965325, 1e-12);
  EXPECT_NEAR(CalcDragCoefficient(DragLaw::kCliftGauvin, 200), 0.7905400398000133, 1e-12);
  EXPECT_NEAR(CalcDragCoefficient(DragLaw::kCliftGraceWeber, 200), 0.7756342422322543, 1e-12);
}

TEST_P(EveryDragLaw, IsStokesDragAtRest) {
  EXPECT_EQ(CalcDragTimesReynolds(GetParam(), 0), 24);
  EXPECT_NEAR(CalcDragTimesReynolds(GetParam(), 1e-9), 24, 1e-4);
}

TEST_P(EveryDragLaw, HasNoJumpUpToAMillion) {
  // steepest: the crisis of Clift, Grace and Weber, 5.3 per decade down to 0.07: 33 times the relative step;
  // where it joins the last segment another 0.137/0.07 within 5 % by a cubic step (slope 1.5): 60 times
  constexpr double kStep = 5e-6;
  double before = CalcDragCoefficient(GetParam(), 1e-2), largest = 0;
  for (double re = 1e-2 * (1 + kStep); re < 1e6; re *= 1 + kStep) {
    const double now = CalcDragCoefficient(GetParam(), re);
    largest = std::max(largest, std::abs(now / before - 1));
    before = now;
  }
  EXPECT_LT(largest, 100 * kStep) << "a tenth of what would count as a jump";
}

TEST_P(EveryDragLaw, ForceGrowsWithSpeedBelowTheCrisis) {
  for (double re = 1e-3, before = 0; re < 1.2e5; re *= 1.001) {
    const double force = re * CalcDragTimesReynolds(GetParam(), re);
    EXPECT_GT(force, before) << re;
    before = force;
  }
}

TEST_P(EveryDragLaw, HasNoCrisisOnARoughBall) {
  const SphereDrag rough{GetParam(), false}, smooth{GetParam(), true};
  for (double re = 1e4; re < 1e6; re *= 1.02) {
    EXPECT_GT(rough.TimesReynolds(re) / re, 0.38) << re;
    EXPECT_LT(rough.TimesReynolds(re) / re, 0.52) << re;
    EXPECT_EQ(smooth.TimesReynolds(re), CalcDragTimesReynolds(GetParam(), re));
  }
  const double held = FindDragLaw(GetParam()).crisis_reynolds;
  if (std::isinf(held)) return;
  // held where the law has its last maximum
  const double top = CalcDragCoefficient(GetParam(), held);
  EXPECT_GT(top, CalcDragCoefficient(GetParam(), 0.99 * held));
  EXPECT_GT(top, CalcDragCoefficient(GetParam(), 1.01 * held));
  EXPECT_DOUBLE_EQ(rough.TimesReynolds(5e5) / 5e5, top);
}

TEST(Drag, CliftGraceAndWebersLastSegmentsMeet) {
  // 0.10 log Re - 0.49 is 0.11 at 1e6, and so is 0.19 - 8e4/Re; with 0.19 log Re it would be 0.65
  EXPECT_NEAR(CalcDragCoefficient(DragLaw::kCliftGraceWeber, 1e6 * (1 - 1e-9)), 0.11, 1e-6);
  EXPECT_NEAR(CalcDragCoefficient(DragLaw::kCliftGraceWeber, 1e6), 0.11, 1e-12);
}

TEST(SpinTorque, IsStokesTorqueWhenSlow) {
  // T = 8 pi mu r^3 w = 1/8 rho nu r^3 (C_w Re_w) w
  EXPECT_DOUBLE_EQ(CalcSpinTorqueTimesReynolds(1) / 8, 8 * std::numbers::pi);
}

TEST(SpinTorque, BranchesMeet) {
  EXPECT_NEAR(CalcSpinTorqueTimesReynolds(32.000001) / CalcSpinTorqueTimesReynolds(32), 1, 2e-3);
}

TEST(SpinTorque, IsSawatzkisBoundaryLayerLawOnTheRadius) {
  // C_w = 6.45 Re_r^-1/2 + 32.1 / Re_r with Re_r = r^2 w / nu = Re_w / 4
  const double re_r = 3e4;
  const double sawatzki = 6.45 / std::sqrt(re_r) + 32.1 / re_r;
  EXPECT_NEAR(CalcSpinTorqueTimesReynolds(4 * re_r) / (4 * re_r) / sawatzki, 1, 1e-12);
}

}  // namespace
}  // namespace piperun::sim
