#include "sim/yaw_pitch_roll.h"

#include <cmath>

namespace piperun::sim {

Quaterniond CalcAttitude(const Vector3d& ypr) {
  return ExpSO3(ypr.x() * Vector3d::UnitZ()) * ExpSO3(ypr.y() * Vector3d::UnitY()) *
         ExpSO3(ypr.z() * Vector3d::UnitX());
}

Vector3d CalcBodyRate(const Vector3d& ypr, const Vector3d& rates) {
  const double sp = std::sin(ypr.y()), cp = std::cos(ypr.y());
  const double sr = std::sin(ypr.z()), cr = std::cos(ypr.z());
  return {rates.z() - rates.x() * sp, rates.y() * cr + rates.x() * cp * sr,
          rates.x() * cp * cr - rates.y() * sr};
}

}  // namespace piperun::sim
