#include "estimator/leak_flow.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/estimator/walk.h"

namespace piperun::estimator {
namespace {

Pipe Dn150() {
  Pipe pipe;
  pipe.diameter_m = 0.1475;
  pipe.wall_thickness_m = 0.0075;
  pipe.material = testing::PvcU();
  return pipe;
}

TEST(LeakFlow, InvertsTheJetInAnUnboundedBand) {
  // int_0^inf g = 1, so p = Zc/2 eps Q. Zc by hand at 10 C: rho = 999.7, c_f = 1447.3, B = 2.0940e9,
  // X = 2 B 0.0775 / (3.5e9 0.0075) = 12.365, c = 1447.3 / sqrt(13.365) = 395.9, A = 0.017087 m2,
  // Zc = 999.7 395.9 / 0.017087 = 2.3163e7; Q = 1 L/min: p = 1.15815e7 0.002 1.66667e-5 = 0.38605 Pa
  const double p_Pa = 0.38605;
  const auto flow = CalcLeakFlow({}, Dn150(), 1e-3, 1e8, p_Pa * p_Pa, 0);
  ASSERT_TRUE(flow);
  EXPECT_NEAR(flow->flow_m3_s * 60e3, 1,
              0.003);  // the four digits above, and Simpson's 64 cells over 11 decades
}

TEST(LeakFlow, TwiceTheSoundInAWideBandIsTwiceTheFlow) {
  const auto one = CalcLeakFlow({}, Dn150(), 1e-3, 1e8, 0.01, 0),
             two = CalcLeakFlow({}, Dn150(), 1e-3, 1e8, 0.04, 0);
  ASSERT_TRUE(one && two);
  EXPECT_NEAR(two->flow_m3_s / one->flow_m3_s, 2, 0.01);
}

TEST(LeakFlow, CalibrationIsItsOwnTermOfTheInterval) {
  const auto flow = CalcLeakFlow({}, Dn150(), 1000, 4000, 0.01, 2);
  ASSERT_TRUE(flow);
  EXPECT_NEAR(flow->sigma_dB, std::sqrt(7.5 * 7.5 + 2 * 2), 1e-12);
}

TEST(LeakFlow, SilenceHasNoFlow) {
  EXPECT_FALSE(CalcLeakFlow({}, Dn150(), 1000, 4000, 0, 1));
  EXPECT_FALSE(CalcLeakFlow({}, Dn150(), 1000, 4000, -1, 1));
}

}  // namespace
}  // namespace piperun::estimator
