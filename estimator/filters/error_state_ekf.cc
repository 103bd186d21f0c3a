#include "estimator/attitude_eskf.h"
#include "estimator/attitude_kind.h"

namespace piperun::estimator::filters::error_state_ekf {

FilterKind Kind() {
  return MakeAttitudeKind<AttitudeEskf>(
      "error_state_ekf",
      "Attitude, gyro bias and lasting acceleration by an error-state Kalman filter on SO(3).");
}

}  // namespace piperun::estimator::filters::error_state_ekf
