#include "sim/soft_contact.h"

#include <gtest/gtest.h>

namespace piperun::sim {
namespace {

constexpr ContactCompliance kFoam{4000, 5};
constexpr double kDt = 1e-3, kResolved_rad_s = 150, kUnresolved_rad_s = 600;

/// F = d (u - v)
double Force(const SoftForce& force, double v) { return force.firmness_N_s_m * (force.speed_m_s - v); }

TEST(SoftContact, PressesWithTheMeansOfOverlapAndSpeed) {
  // overlap 0.2 mm, 0.1 m/s before and 0.08 m/s after: neighbours at 0.1 and 0.28 mm
  const double x = (1e-4 + 2 * 2e-4 + 2.8e-4) / 4, rate = 0.09;
  EXPECT_NEAR(Force(CalcSoftForce(kFoam, {-2e-4, -0.1, kResolved_rad_s}, kDt), -0.08), 4000 * x + 5 * rate,
              1e-14);
}

TEST(SoftContact, DoesNotPressBeforeTheWall) {
  EXPECT_EQ(CalcSoftForce(kFoam, {1e-6, -0.3, kResolved_rad_s}, kDt).firmness_N_s_m, 0);
}

TEST(SoftContact, OfALongStepPressesWithWhatItsEndHas) {
  const SoftForce force = CalcSoftForce(kFoam, {-2e-4, -0.1, kUnresolved_rad_s}, kDt);
  EXPECT_NEAR(Force(force, -0.08), 4000 * (2e-4 + 0.08 * kDt) + 5 * 0.08, 1e-14);
  // before the wall, only what would reach beyond it counts
  EXPECT_NEAR(CalcSoftForce(kFoam, {1e-4, -0.3, kUnresolved_rad_s}, kDt).speed_m_s, -0.1, 1e-15);
}

}  // namespace
}  // namespace piperun::sim
