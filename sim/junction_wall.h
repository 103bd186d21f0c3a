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

/// A disc across an arm. Its points are those of a quadrature (Gauss radially, equal angles around) whose
/// areas add up to the disc.
struct ArmSection {
  std::size_t arm = 0;
  double to_end_m = 0;  ///< from here to the arm's end; 0: it is the end
  std::vector<WallPoint> points;
};

/// The water of a joint and where to put the sources that drive it. Origin: the node; axes of W.
struct JunctionWall {
  std::vector<WallPoint> wall;
  std::vector<ArmSection> sections;  ///< along the part of each arm that is a whole tube, its end included
  std::vector<Vector3d> sources;     ///< outside
};

/// Axes of an arm as columns: x towards the other arms where they have a side, z along the arm.
Matrix3d MakeArmAxes(const Joint& joint, std::size_t arm);

/// The surface of the union of the arms' tubes, up to `core_m` along each, and of the joint's sphere, lips
/// rounded, in patches of about `wall_spacing` radii, finer near sources; and points about half a radius
/// outside of it. The rounding of a right-angled lip begins 0.8 radii (of the narrower bore) from it and
/// takes 0.28 radii off its edge.
JunctionWall MakeJunctionWall(const Joint& joint, std::span<const double> core_m, double wall_spacing = 0.26);

}  // namespace piperun::sim
