#include "acoustics/propagation.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/acoustics/scenes.h"

namespace piperun::acoustics {
namespace {

/// 10 m of PVC, 20 m of iron, 5 m of PVC.
std::vector<AcousticLeg> MakeLegs() {
  return {{0, 10, MakePvcWave()}, {10, 20, MakeIronWave()}, {30, 5, MakePvcWave()}};
}

TEST(Propagation, LossAddsUpOverTheLegsOnTheWay) {
  const double f_Hz = 700;
  const double pvc = MakePvcWave().Attenuation_Np_m(f_Hz), iron = MakeIronWave().Attenuation_Np_m(f_Hz);
  EXPECT_NEAR(CalcPathLoss_Np(MakeLegs(), 2, 7, f_Hz), 5 * pvc, 1e-14);
  EXPECT_NEAR(CalcPathLoss_Np(MakeLegs(), 4, 33, f_Hz), 9 * pvc + 20 * iron, 1e-14);
  EXPECT_NEAR(CalcPathLoss_Np(MakeLegs(), 15, 12, f_Hz), 3 * iron, 1e-14);
}

TEST(Propagation, SoundRunsBothWaysAlike) {
  for (const double a : {-1.0, 3.0, 10.0, 17.5}) {
    for (const double b : {0.0, 12.0, 30.0, 36.0}) {
      EXPECT_DOUBLE_EQ(CalcPathLoss_Np(MakeLegs(), a, b, 300), CalcPathLoss_Np(MakeLegs(), b, a, 300));
    }
  }
}

TEST(Propagation, TheOuterLegsGoOnBeyondTheRoute) {
  const double pvc = MakePvcWave().Attenuation_Np_m(300);
  EXPECT_NEAR(CalcPathLoss_Np(MakeLegs(), -3, 1, 300), 4 * pvc, 1e-14);
  EXPECT_NEAR(CalcPathLoss_Np(MakeLegs(), 34, 38, 300), 4 * pvc, 1e-14);
}

TEST(Propagation, ALegHoldsItsBeginningNotItsEnd) {
  EXPECT_EQ(FindLeg(MakeLegs(), -1), 0u);
  EXPECT_EQ(FindLeg(MakeLegs(), 9.999), 0u);
  EXPECT_EQ(FindLeg(MakeLegs(), 10), 1u);
  EXPECT_EQ(FindLeg(MakeLegs(), 30), 2u);
  EXPECT_EQ(FindLeg(MakeLegs(), 99), 2u);
}

TEST(Propagation, PressureAtTheHoleIsHalfTheImpedanceTimesTheVolumeVelocity) {
  AcousticScene scene = MakeQuietScene(MakePvcWave());
  scene.legs = MakeLegs();
  AddLeak(scene, 20, std::make_shared<FlatSound>(4e-20, 0, 1e9));
  const double half_impedance = MakeIronWave().impedance_Pa_s_m3 / 2;
  EXPECT_NEAR(CalcLeakPsdAtHole(scene, scene.leaks[0], 500) / (half_impedance * half_impedance * 4e-20), 1,
              1e-12);
  const double loss_Np = 6 * MakeIronWave().Attenuation_Np_m(500);
  EXPECT_NEAR(CalcLeakPsd(scene, scene.leaks[0], 14, 500) / CalcLeakPsdAtHole(scene, scene.leaks[0], 500),
              std::exp(-2 * loss_Np), 1e-12);
}

}  // namespace
}  // namespace piperun::acoustics
