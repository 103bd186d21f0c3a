#include "sim/wall_factor.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace piperun::sim {
namespace {

constexpr WallFactorLaw kAll[] = {WallFactorLaw::kKehlenbeckDiFelice, WallFactorLaw::kDiFelice,
                                  WallFactorLaw::kMunroe, WallFactorLaw::kNewton, WallFactorLaw::kNone};

class EveryWallFactor : public ::testing::TestWithParam<WallFactorLaw> {};
INSTANTIATE_TEST_SUITE_P(All, EveryWallFactor, ::testing::ValuesIn(kAll),
                         [](const auto& law) { return std::string(FindWallFactorLaw(law.param).key); });

TEST(WallFactor, MatchesTheHighReynoldsTable) {
  // the last at l = 0.6 by hand: l0 = 1.2, p = 2.3; (1 - 0.30886)/(1 + 0.20306) = 0.57449
  struct Row {
    double l, newton, munroe, di_felice, kehlenbeck;
  };
  constexpr Row kTable[] = {{0.1, 0.988, 0.968, 0.941, 0.992}, {0.2, 0.950, 0.911, 0.877, 0.960},
                            {0.3, 0.889, 0.836, 0.807, 0.900}, {0.4, 0.806, 0.747, 0.731, 0.813},
                            {0.5, 0.702, 0.646, 0.647, 0.703}, {0.6, 0.580, 0.535, 0.554, 0.57449},
                            {0.8, 0.297, 0.284, 0.330, 0.288}};
  constexpr double kRounded = 5.1e-4, kHigh = 1e12;
  for (const auto& [l, newton, munroe, di_felice, kehlenbeck] : kTable) {
    EXPECT_NEAR(CalcWallFactor(WallFactorLaw::kNewton, l, kHigh), newton, kRounded) << l;
    EXPECT_NEAR(CalcWallFactor(WallFactorLaw::kMunroe, l, kHigh), munroe, kRounded) << l;
    EXPECT_NEAR(CalcWallFactor(WallFactorLaw::kDiFelice, l, kHigh), di_felice, kRounded) << l;
    EXPECT_NEAR(CalcWallFactor(WallFactorLaw::kKehlenbeckDiFelice, l, kHigh), kehlenbeck, kRounded) << l;
  }
}

TEST(WallFactor, OfDiFeliceHasItsReynoldsDependentExponent) {
  // (3.3 - a)/(a - 0.85) = 0.1 Re: at Re = 10 a = (3.3 + 0.85)/2 = 2.075; at rest 3.3; ((1-l)/(1-0.33 l)) at
  // l = 0.5 = 0.5/0.835
  EXPECT_NEAR(CalcWallFactor(WallFactorLaw::kDiFelice, 0.5, 10), std::pow(0.5 / 0.835, 2.075), 1e-12);
  EXPECT_NEAR(CalcWallFactor(WallFactorLaw::kDiFelice, 0.5, 0), std::pow(0.5 / 0.835, 3.3), 1e-12);
}

TEST(WallFactor, IsNewtonsAtHighReynolds) {
  for (double l = 0.05; l <= 0.6; l += 0.05) {
    const double newton = (1 - l * l) * std::sqrt(1 - 0.5 * l * l);
    EXPECT_NEAR(CalcWallFactor(WallFactorLaw::kKehlenbeckDiFelice, l, 1e12) / newton, 1, 0.015) << l;
  }
}

TEST(WallFactor, IsNearHabermanAndSayreInStokesFlow) {
  EXPECT_NEAR(CalcWallFactor(WallFactorLaw::kKehlenbeckDiFelice, 0.1, 0), 0.792, 0.005);
}

TEST(WallFactor, HasNoJumpWhereTheBranchesOfItsExponentMeet) {
  // 1.44 + 0.5466 Re^0.434 = 2.3 + 37.3 Re^-0.8686 at Re = 35.04
  double low = 30, high = 40;
  for (int i = 0; i < 100; ++i) {
    const double re = 0.5 * (low + high);
    (1.44 + 0.5466 * std::pow(re, 0.434) < 2.3 + 37.3 * std::pow(re, -0.8686) ? low : high) = re;
  }
  for (double l = 0.05; l < 0.951; l += 0.05) {
    const auto f = [&](double re) { return CalcWallFactor(WallFactorLaw::kKehlenbeckDiFelice, l, re); };
    EXPECT_NEAR(f(low * (1 + 1e-8)) / f(low * (1 - 1e-8)), 1, 1e-6) << l;
  }
}

TEST_P(EveryWallFactor, FallsWithTheRatioAndGrowsWithReynolds) {
  for (double l = 0.05; l < 0.951; l += 0.05) {
    for (double re = 1e-4; re < 1e7; re *= 1.1) {
      const double f = CalcWallFactor(GetParam(), l, re);
      EXPECT_TRUE(f > 0 && f <= 1) << l << " " << re;
      EXPECT_LE(CalcWallFactor(GetParam(), l + 0.001, re), f) << l << " " << re;
    }
    EXPECT_GE(CalcWallFactor(GetParam(), l, 1e6), CalcWallFactor(GetParam(), l, 1)) << l;
  }
}

TEST_P(EveryWallFactor, SolvedForTheSpeedInTheTubeIsThatOfTheFreeSphere) {
  for (const double l : {0.05, 0.4, 0.8, 0.95}) {
    for (double re = 1e-6; re < 1e8; re *= 7) {
      const double f = std::exp(SolveLogWallFactor(GetParam(), l, re));
      EXPECT_NEAR(CalcWallFactor(GetParam(), l, re / f) / f, 1, 1e-7) << l << " " << re;
    }
    EXPECT_NEAR(std::exp(SolveLogWallFactor(GetParam(), l, 0)), CalcWallFactor(GetParam(), l, 0), 1e-15);
  }
}

TEST_P(EveryWallFactor, TableIsTheSolutionWithinAMillionth) {
  for (const double l : {0.05, 0.3, 0.6, 0.8, 0.9, 0.95}) {
    const WallFactorTable table(GetParam(), l);
    for (double re = 1; re < 1e8; re *= 1.0137) {
      EXPECT_NEAR(table.EvalLog(re), SolveLogWallFactor(GetParam(), l, re), 1e-6) << l << " " << re;
    }
  }
}

}  // namespace
}  // namespace piperun::sim
