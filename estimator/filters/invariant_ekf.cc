#include "estimator/attitude_iekf.h"
#include "estimator/attitude_kind.h"

namespace piperun::estimator::filters::invariant_ekf {

FilterKind Kind() {
  return MakeAttitudeKind<AttitudeIekf>(
      "invariant_ekf", "Attitude and gyro bias by an imperfect right-invariant Kalman filter on SO(3).");
}

}  // namespace piperun::estimator::filters::invariant_ekf
