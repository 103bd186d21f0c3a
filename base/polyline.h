#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "base/pose.h"

namespace piperun {

/// One straight of a polyline, vertex to vertex.
struct Straight {
  Vector3d tangent_W;
  double length_m = 0;
};

/// A polyline as its vertices and as what lies between them; the tangents are kept apart, so that they stay
/// the same to the last bit when lengths change.
struct Polyline {
  std::vector<Vector3d> vertices_W;
  std::vector<Straight> straights;  ///< one fewer than vertices
};

/// Shortest straight there is.
inline constexpr double kMinStraight_m = 1e-6;

/// "corner 2 at [10, 2, 0]".
std::string CornerName(std::size_t i, const Vector3d& p_W);

/// Throws InputError when two neighbouring vertices coincide.
Polyline MakePolyline(std::vector<Vector3d> vertices_W);

/// Angle in [0, pi] by which a line turns that comes along one unit vector and leaves along another.
double CalcTurn_rad(const Vector3d& tangent_in, const Vector3d& tangent_out);

/// The vertices moved so that the polyline has the length L: horizontally and away from the first one, by the
/// factor f >= 0 that solves
///
///   sum sqrt((f h_i)^2 + z_i^2) = L        h_i, z_i: run and rise of straight i
///
/// Elevations stay. A polyline that is a point in plan runs due east, with a constant slope (or none). Throws
/// InputError when L is below the rise sum |z_i|, which no stretching can shorten.
std::vector<Vector3d> StretchToLength(std::vector<Vector3d> vertices_W, double length_m);

}  // namespace piperun
