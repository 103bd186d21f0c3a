#include "estimator/gradient_ekf.h"

#include "estimator/complementary_kind.h"

namespace piperun::estimator::filters::gradient_ekf {

FilterKind Kind() {
  return MakeComplementaryKind<GradientEkf, GradientEkfParams>(
      "gradient_ekf", "Quaternion Kalman filter that observes a step of gradient descent, after the thesis.");
}

}  // namespace piperun::estimator::filters::gradient_ekf
