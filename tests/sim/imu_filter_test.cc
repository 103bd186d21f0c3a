#include "sim/imu_filter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/check.h"

namespace piperun::sim {
namespace {

const Rate kRate(1000);

/// Amplitude at which a sine of unit amplitude leaves, from in-phase and quadrature over whole periods.
template <class Filter>
double MeasureGain(double f_Hz, const Filter& filter) {
  double in_phase = 0, quadrature = 0;
  const int settle = 4000, count = 10'000;
  for (int k = 0; k < settle + count; ++k) {
    const double phase = 2 * std::numbers::pi * f_Hz * k / 1000;
    const double y = filter(std::sin(phase));
    if (k < settle) continue;
    in_phase += 2 * y * std::sin(phase) / count;
    quadrature += 2 * y * std::cos(phase) / count;
  }
  return std::hypot(in_phase, quadrature);
}

TEST(ImuFilter, HasTheGainOfItsAnaloguePrototype) {
  for (const std::int64_t order : {1, 2}) {
    for (const double bandwidth_Hz : {10.0, 50.0, 200.0}) {
      const LowPass filter = MakeLowPass(order, bandwidth_Hz, kRate);
      for (const double f_Hz : {1.0, 5.0, bandwidth_Hz, 300.0}) {
        // bilinear: the prototype at the warped frequency
        const double x =
            std::tan(std::numbers::pi * f_Hz / 1000) / std::tan(std::numbers::pi * bandwidth_Hz / 1000);
        const double expected = 1 / std::sqrt(1 + std::pow(x, 2 * static_cast<double>(order)));
        LowPassState state;
        const double gain =
            MeasureGain(f_Hz, [&](double x_k) { return Step(state, Vector3d(x_k, 0, 0), filter).x(); });
        EXPECT_NEAR(gain, expected, 1e-9) << order << ", " << bandwidth_Hz << ", " << f_Hz;
        EXPECT_NEAR(std::abs(CalcResponse(filter, f_Hz, kRate)), expected, 1e-12);
      }
    }
  }
}

TEST(ImuFilter, ABoxcarHasTheGainOfADirichletKernel) {
  BoxcarState state = MakeSteady(Vector3d::Zero());
  const double gain = MeasureGain(70, [&](double x) { return Step(state, Vector3d(0, x, 0), 8).y(); });
  const double a = std::numbers::pi * 70 / 1000;
  EXPECT_NEAR(gain, std::sin(8 * a) / (8 * std::sin(a)), 1e-12);
}

TEST(ImuFilter, StartsSteady) {
  const Vector3d x(1, -2, 3);
  const LowPass filter = MakeLowPass(2, 17, kRate);
  LowPassState state = MakeSteady(filter, x);
  for (int k = 0; k < 100; ++k) EXPECT_LT((Step(state, x, filter) - x).norm(), 1e-13);
  BoxcarState boxcar = MakeSteady(x);
  for (int k = 0; k < 10; ++k) EXPECT_LT((Step(boxcar, x, 7) - x).norm(), 1e-15);
}

TEST(ImuFilter, RefusesABandwidthThePhysicsRateCannotShow) {
  ImuFilterParams p;
  p.analogue_bandwidth_Hz = 600;
  try {
    MakeImuFilter(p, kRate);
    FAIL();
  } catch (const InputError& e) {
    EXPECT_EQ(e.key_path(), "analogue_bandwidth_Hz");
    EXPECT_NE(e.problem().find("600"), std::string::npos);
    EXPECT_NE(e.problem().find("1000"), std::string::npos);
  }
}

}  // namespace
}  // namespace piperun::sim
