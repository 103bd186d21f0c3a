#pragma once

#include <span>
#include <vector>

#include "sim/bore.h"

namespace piperun::sim {

/// A bit of the surface that bounds the water of a joint.
struct WallPoint {
  Vector3d p_N;
  Vector3d normal;  ///< unit, out of the water
  double area_m2 = 0;
};

/// The water of a joint and where to put the sources that drive it. Origin: the node; axes of W.
struct JunctionWall {
  std::vector<WallPoint> wall;
  std::vector<std::vector<WallPoint>> sections;  ///< per arm: its end, a disc across it
  std::vector<Vector3d> sources;                 ///< outside
};

/// Axes of an arm as columns: x towards the other arms where they have a side, z along the arm.
Matrix3d MakeArmAxes(const Joint& joint, std::size_t arm);

/// The surface of the union of the arms' tubes, up to `core_m` along each, and of the joint's sphere, in
/// patches of about `wall_spacing` radii; and points half a radius outside of it. Section points are
/// those of a quadrature (Gauss radially, equal angles around) whose area weights add up to the disc.
/// Symmetric where the joint is.
JunctionWall MakeJunctionWall(const Joint& joint, std::span<const double> core_m, double wall_spacing = 0.26);

}  // namespace piperun::sim
