#pragma once

#include <LinearMath/btVector3.h>

#include "base/pose.h"

namespace piperun::sim::bullet {

inline btVector3 ToBullet(const Vector3d& v) { return {v.x(), v.y(), v.z()}; }
inline Vector3d FromBullet(const btVector3& v) { return {v.x(), v.y(), v.z()}; }

}  // namespace piperun::sim::bullet
