#pragma once

#include <limits>

#include "sim/wall_foot.h"

namespace piperun::sim {

/// A convex body of water; a joint is the union of some of them. Either a straight piece of bore,
///
///   0 <= t <= length, rho <= R,   t = (q - origin) . axis,  rho = |q - origin - t axis|,
///
/// or, with `axis` zero, a sphere |q - origin| <= R. Vectors in the axes of W, from the joint's node N.
struct BoreMember {
  Vector3d origin = Vector3d::Zero();
  Vector3d axis = Vector3d::Zero();  ///< unit, into the pipe; zero: a sphere
  double radius_m = 0;
  double length_m = std::numeric_limits<double>::infinity();
  double plate_m = std::numeric_limits<double>::infinity();  ///< t of the plate that shuts the bore

  bool sphere() const { return axis.isZero(0); }
};

/// How deep p lies inside: its distance to the nearest wall or end of the bore; negative: outside, and then
/// no more than the distance to the member.
double CalcDepth(const BoreMember& member, const Vector3d& p_N);

/// The way deeper into the member, unit: gradient of CalcDepth.
Vector3d CalcDeepening(const BoreMember& member, const Vector3d& p_N);

/// Normal of the curved wall at the foot of p, pointing inwards; p must not lie on the axis or at the centre.
Vector3d CalcWallNormal(const BoreMember& member, const Vector3d& p_N);

/// The foot of p on the curved wall, seen from inside. False when p lies outside, or (within 1e-9 m) on
/// the axis or at the centre: there no wall is nearest.
bool FindWallFoot(const BoreMember& member, const Vector3d& p_N, WallFoot& foot);

/// Largest t at which begin + t direction lies in the member; -infinity: nowhere.
double CalcExit(const BoreMember& member, const Vector3d& begin_N, const Vector3d& direction);

}  // namespace piperun::sim
