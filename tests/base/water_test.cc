#include "base/water.h"

#include <gtest/gtest.h>

namespace piperun {
namespace {

struct Published {
  double temperature_C;
  double density_kg_m3;
  double viscosity_mPa_s;
};

// Density: CRC Handbook of Chemistry and Physics, "Standard density of water" (ITS-90, 101.325 kPa).
// Viscosity: IAPWS 2008 formulation (release R12-08) at those densities, five digits.
constexpr Published kTable[] = {{5, 999.9668, 1.5182},  {10, 999.7026, 1.3059}, {15, 999.1026, 1.1376},
                                {20, 998.2071, 1.0016}, {25, 997.0479, 0.8900}, {40, 992.2187, 0.6527}};

/// Bilaniuk & Wong, J. Acoust. Soc. Am. 93, 1609 (1993), 148-point polynomial: another fit, on ITS-90, to the
/// measurements of Del Grosso & Mader (1972).
double BilaniukWong(double t) {
  return 1402.38744 + t * (5.03836171 + t * (-5.81172916e-2 +
                                             t * (3.34638117e-4 + t * (-1.48259672e-6 + t * 3.16585020e-9))));
}

// Kell's scale puts the densest water at 999.972 kg/m3, today's at 999.975: a constant 0.003
TEST(Water, DensityIsThePublishedOne) {
  for (const Published& row : kTable) {
    EXPECT_NEAR(CalcWater(row.temperature_C).density_kg_m3, row.density_kg_m3, 0.004) << row.temperature_C;
  }
}

TEST(Water, ViscosityIsThePublishedOneWithinATenthOfAPercent) {
  for (const Published& row : kTable) {
    const WaterProperties water = CalcWater(row.temperature_C);
    const double viscosity_mPa_s = 1e3 * water.kinematic_viscosity_m2_s * water.density_kg_m3;
    EXPECT_NEAR(viscosity_mPa_s / row.viscosity_mPa_s, 1, 0.001) << row.temperature_C;
  }
}

TEST(Water, SoundSpeedAgreesWithAnIndependentFitOfTheMeasurements) {
  for (double t = 0; t <= 60; t += 5) {
    EXPECT_NEAR(CalcWater(t).sound_speed_m_s, BilaniukWong(t), 0.05) << t;
  }
  EXPECT_NEAR(CalcWater(20).sound_speed_m_s, 1482.38, 0.005);  // Marczak 1997
}

TEST(Water, IsDensestNearFourDegrees) {
  const double densest = CalcWater(3.98).density_kg_m3;
  EXPECT_GT(densest, CalcWater(3.5).density_kg_m3);
  EXPECT_GT(densest, CalcWater(4.5).density_kg_m3);
  EXPECT_NEAR(densest, 999.975, 0.004);
}

TEST(WaterDeathTest, IceAndSteamAbort) {
  EXPECT_DEATH(CalcWater(-0.1), "between 0 and 60");
  EXPECT_DEATH(CalcWater(60.1), "between 0 and 60");
}

}  // namespace
}  // namespace piperun
