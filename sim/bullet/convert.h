#pragma once

#include <LinearMath/btMatrix3x3.h>

#include "base/pose.h"

namespace piperun::sim::bullet {

inline btVector3 ToBullet(const Vector3d& v) { return {v.x(), v.y(), v.z()}; }
inline btMatrix3x3 MatrixToBullet(const Matrix3d& m) {
  return {m(0, 0), m(0, 1), m(0, 2), m(1, 0), m(1, 1), m(1, 2), m(2, 0), m(2, 1), m(2, 2)};
}
inline Vector3d FromBullet(const btVector3& v) { return {v.x(), v.y(), v.z()}; }

}  // namespace piperun::sim::bullet
