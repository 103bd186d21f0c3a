#include "estimator/attitude_kind.h"
#include "estimator/attitude_ukf.h"

namespace piperun::estimator::filters::unscented_kf {

FilterKind Kind() {
  return MakeAttitudeKind<AttitudeUkf>(
      "unscented_kf", "Attitude and gyro bias by an unscented Kalman filter on SO(3) x R^3.");
}

}  // namespace piperun::estimator::filters::unscented_kf
