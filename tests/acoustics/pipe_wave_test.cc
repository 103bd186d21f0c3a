#include "acoustics/pipe_wave.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>

#include "base/check.h"
#include "tests/acoustics/scenes.h"

namespace piperun::acoustics {
namespace {

using std::numbers::pi;

constexpr double kDecibelPerNeper = 8.685889638065035;

/// A row of the parameter table for water mains at 10 C (mean radius, wall, modulus, loss factor). The table
/// prints the mean radius to a millimetre; DI DN300 has an outer diameter of 326 mm, so 159.4 mm.
struct PipeRow {
  const char* name;
  double mean_radius_m, wall_m, young_Pa, loss_factor;
  double X, speed_m_s, dB_m_100Hz, dB_m_1kHz, dB_m_3kHz, cut_on_Hz;
};

const PipeRow kRows[] = {
    {"MDPE 180 SDR17", .085, .0107, 2.0e9, .06, 16.6, 345, .455, 4.50, 13.5, 5320},
    {"HDPE 315 SDR11", .143, .0286, 1.2e9, .06, 17.5, 337, .464, 4.61, 13.8, 3290},
    {"PVC-U DN150", .0775, .0075, 3.5e9, .05, 12.4, 396, .325, 3.21, 9.6, 5750},
    {"PVC-U DN300", .152, .0121, 3.5e9, .05, 15.0, 361, .357, 3.55, 10.6, 2900},
    {"AC DN150", .084, .015, 24e9, .02, .98, 1029, .028, .269, .80, 5540},
    {"DI DN100 K9", .056, .006, 165e9, .02, .24, 1301, .011, .088, .26, 8000},
    {"DI DN150 K9", .082, .006, 165e9, .02, .35, 1247, .013, .118, .35, 5370},
    {"DI DN300 K9", .1594, .0072, 165e9, .02, .56, 1158, .018, .173, .51, 2720},
    {"Steel DN600", .302, .008, 207e9, .01, .76, 1090, .011, .110, .33, 1420},
    {"Copper 22 mm", .0106, .0009, 120e9, .005, .41, 1219, .018, .078, .18, 42000},
};

class PipeWaveTable : public testing::TestWithParam<PipeRow> {};

/// Half a unit of the last printed digit, and 0.1 % for the water constants the table was computed with.
double Rounding(double printed, double last_digit) { return 0.5 * last_digit + 1e-3 * printed; }

TEST_P(PipeWaveTable, AgreesWithTheParameterTable) {
  const PipeRow& row = GetParam();
  const PipeWave wave = CalcPipeWave(2 * row.mean_radius_m - row.wall_m, row.wall_m,
                                     MakeWall(row.young_Pa, row.loss_factor), MakeWater10C());
  const auto dB_m = [&](double f_Hz) { return kDecibelPerNeper * wave.Attenuation_Np_m(f_Hz); };
  EXPECT_NEAR(wave.X, row.X, Rounding(row.X, row.X > 10 ? .1 : .01));
  EXPECT_NEAR(wave.speed_m_s, row.speed_m_s, Rounding(row.speed_m_s, 1));
  EXPECT_NEAR(dB_m(100), row.dB_m_100Hz, Rounding(row.dB_m_100Hz, .001));
  EXPECT_NEAR(dB_m(1000), row.dB_m_1kHz, Rounding(row.dB_m_1kHz, row.dB_m_1kHz > 1 ? .01 : .001));
  EXPECT_NEAR(dB_m(3000), row.dB_m_3kHz, Rounding(row.dB_m_3kHz, row.dB_m_3kHz > 1 ? .1 : .01));
  EXPECT_NEAR(wave.cut_on_Hz, row.cut_on_Hz, Rounding(row.cut_on_Hz, row.cut_on_Hz > 9000 ? 1000 : 10));
}

INSTANTIATE_TEST_SUITE_P(Mains, PipeWaveTable, testing::ValuesIn(kRows));

TEST(PipeWave, EqualsTheFormulaToOnePartInABillion) {
  const WaterProperties water = CalcWater(17);
  const double d = 0.2031, h = 0.0093, E = 2.7e9, eta = 0.043, nu_p = 0.37, rho_p = 1390;
  const PipeWave wave = CalcPipeWave(d, h, MakeWall(E, eta, nu_p, rho_p), water);

  const double rho = water.density_kg_m3, c_f = water.sound_speed_m_s;
  const double a = (d + h) / 2;
  const double X = 2 * rho * std::pow(c_f, 2) * a / (E * h);
  const double c =
      std::pow(1 / std::pow(c_f, 2) + 2 * rho * a / (E * h), -0.5);  // Korteweg's series of springs
  EXPECT_NEAR(wave.X / X, 1, 1e-9);
  EXPECT_NEAR(wave.speed_m_s / c, 1, 1e-9);
  EXPECT_NEAR(wave.impedance_Pa_s_m3 / (4 * rho * c / (pi * d * d)), 1, 1e-9);
  EXPECT_NEAR(wave.ring_frequency_Hz / (std::sqrt(E / rho_p / (1 - nu_p * nu_p)) / (pi * (d + h))), 1, 1e-9);
  for (const double f : {1.0, 50.0, 1000.0, 7900.0}) {
    // omega beta with beta = (eta B a / E h) / (c_f sqrt(1 + X)), plus Kirchhoff's wall friction
    const double beta = eta * rho * c_f * c_f * a / (E * h) / (c_f * std::sqrt(1 + X));
    const double friction = std::sqrt(pi * f * water.kinematic_viscosity_m2_s) / (d / 2) / c;
    EXPECT_NEAR(wave.Attenuation_Np_m(f) / (2 * pi * f * beta + friction), 1, 1e-9);
  }
}

TEST(PipeWave, LossIsTheImaginaryPartOfTheComplexWavenumber) {
  // k = (omega / c_f) sqrt(1 + X / (1 + i eta)): the compact form is its first order in eta
  const double eta = 1e-4, f = 500;
  WaterProperties water = MakeWater10C();
  water.kinematic_viscosity_m2_s = 1e-30;
  const PipeWave wave = CalcPipeWave(0.1475, 0.0075, MakeWall(3.5e9, eta), water);
  const std::complex<double> k =
      2 * pi * f / water.sound_speed_m_s * std::sqrt(1.0 + wave.X / std::complex<double>(1, eta));
  EXPECT_NEAR(wave.Attenuation_Np_m(f) / -k.imag(), 1, 1e-7);
  EXPECT_NEAR(2 * pi * f / wave.speed_m_s / k.real(), 1, 1e-7);
}

TEST(PipeWave, RigidWallLeavesTheSpeedOfFreeWater) {
  const WaterProperties water = MakeWater10C();
  const PipeWave wave = CalcPipeWave(0.15, 0.01, MakeWall(1e20, 0), water);
  EXPECT_NEAR(wave.speed_m_s, water.sound_speed_m_s, 1e-6);
}

TEST(PipeWave, FrictionAtTheWallGrowsWithTheRootOfFrequency) {
  // Kirchhoff's term alone: 0.005 dB/m sqrt(f / 1 kHz) in DN150
  const PipeWave wave = CalcPipeWave(0.158, 0.006, MakeWall(165e9, 0), MakeWater10C());
  EXPECT_NEAR(kDecibelPerNeper * wave.Attenuation_Np_m(1000), 0.005, 0.001);
  EXPECT_NEAR(wave.Attenuation_Np_m(4000) / wave.Attenuation_Np_m(1000), 2, 1e-12);
}

TEST(PipeWave, RefusesAWallThatIsNone) {
  EXPECT_THROW(CalcPipeWave(0.15, 0, MakeWall(3.5e9, 0.05), MakeWater10C()), InputError);
  EXPECT_THROW(CalcPipeWave(-0.15, 0.01, MakeWall(3.5e9, 0.05), MakeWater10C()), InputError);
  EXPECT_THROW(CalcPipeWave(0.15, 0.01, MakeWall(0, 0.05), MakeWater10C()), InputError);
  EXPECT_THROW(CalcPipeWave(0.15, 0.01, MakeWall(3.5e9, -1), MakeWater10C()), InputError);
  EXPECT_THROW(CalcPipeWave(0.15, 0.01, MakeWall(3.5e9, 0.05, NAN), MakeWater10C()), InputError);
}

}  // namespace
}  // namespace piperun::acoustics
