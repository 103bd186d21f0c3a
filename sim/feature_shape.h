#pragma once

#include <memory>
#include <optional>
#include <variant>
#include <vector>

#include "sim/joint_lip.h"
#include "sim/wall_foot.h"

namespace piperun::sim {

// What wall features are made of. Every shape has a frame G: origin on the pipe's axis, x along it, y across
// it in the direction the shape points to, z = x cross y. Of a point p, rho = |(y, z)| is the distance from
// x.

/// A bead all around the bore: a torus of tube radius a around the circle x = 0, rho = R_c.
struct RingBead {
  double circle_radius_m = 0;  ///< R_c
  double tube_radius_m = 0;    ///< a
  double half_width_m = 0;     ///< of what stands out of the wall
};

/// One rim of a groove: the bore's wall goes over into the groove's face along a rounding of radius a. The
/// rim's circle lies at x = 0, rho = R + a; the wall ends and the rounding begins at x = 0.
struct GrooveRim {
  double bore_radius_m = 0;  ///< R
  double edge_radius_m = 0;  ///< a; 0: sharp
  double side = 1;           ///< the groove lies towards side * x > 0
};

/// The groove between two rims: no wall for |s| < w/2 + a, but a floor `depth` behind it for |s| < w/2, with
/// s the distance along the axis.
struct GrooveFloor {
  double half_width_m = 0;  ///< w/2
  double edge_radius_m = 0;
  double depth_m = 0;
};

/// The next stick of pipe, out of line by e: a bore of radius R whose axis leads from (0, -e, 0) back to (l,
/// 0, 0), with a rim that is rounded by a. Towards y its edge stands e high in the bore.
struct OffsetSleeve {
  double bore_radius_m = 0;  ///< R
  double edge_radius_m = 0;  ///< a
  double offset_m = 0;       ///< e
  double ramp_m = 0;         ///< l
};

/// A lump: a sphere of radius a around (0, c, 0), of which a cap stands out of the wall.
struct Boss {
  double centre_m = 0;  ///< c
  double radius_m = 0;  ///< a
  double base_m = 0;    ///< radius of the cap's base
};

/// A gate across the bore: |x| <= b, y >= y_e, its edge rounded by a.
struct GateLeaf {
  double edge_m = 0;            ///< y_e; negative: beyond the axis
  double half_thickness_m = 0;  ///< b
  double edge_radius_m = 0;     ///< a, at most b
};

/// Where a smaller tube along y opens into the bore: no wall within the hole, and the sharp edge where the
/// two cylinders meet (sim/joint_lip.h).
class ServiceHole {
 public:
  /// radius < bore_radius
  ServiceHole(double bore_radius_m, double radius_m);
  double radius_m() const { return radius_m_; }
  /// Whether a point of the bore's wall lies within the hole.
  bool Covers(const Vector3d& q_G) const;
  void AddFeet(const Vector3d& p_G, double limit_m, double ring_m, WallFeet& feet) const;

 private:
  struct Edge;
  double radius_m_;
  std::shared_ptr<const Edge> edge_;
};

using ShapeBody = std::variant<RingBead, GrooveRim, GrooveFloor, OffsetSleeve, Boss, GateLeaf, ServiceHole>;

/// A shape in a pipe: its frame G stands at s of the axis, y as near to `towards_W` as is across the pipe.
struct FeatureShape {
  double s_m = 0;
  Vector3d towards_W = Vector3d::UnitZ();
  ShapeBody body;
};

/// One thing on a pipe's wall that a ball runs into.
struct WallFeature {
  int pipe = -1;
  double s_m = 0;  ///< its middle
  std::vector<FeatureShape> shapes;
};

/// The torus of which a cap of height h and width w stands out of the wall: a = (h^2 + (w/2)^2) / 2h.
RingBead MakeRingBead(double bore_radius_m, double height_m, double width_m);
/// The sphere of which a cap of height h on a base of diameter b stands out of the wall.
Boss MakeBoss(double bore_radius_m, double height_m, double base_diameter_m);

/// From where to where along x a body reaches into the bore.
struct ShapeExtent {
  double begin_m = 0;
  double end_m = 0;
};
ShapeExtent CalcExtent(const ShapeBody& body);

/// Adds the points of a body that are locally nearest to p, normals in G, `body` and `feature` left out; a
/// ball that jams in a ring touches it all around: where the far side is less than `ring_m` farther, also the
/// points 120 degrees around. Closed forms, but for a hole's edge.
void AddBodyFeet(const ShapeBody& body, const Vector3d& p_G, double limit_m, double ring_m, WallFeet& feet);

/// How far the bore's wall has receded at q: 0 where it stands, infinite where there is none. `ds_m`:
/// distance of q from the shape along the axis.
double CalcRecess_m(const ShapeBody& body, double ds_m, const Vector3d& q_G);

/// Part of the wall: its feet go over into the wall's own and back. Others stand on it.
bool IsEdgeOfWall(const ShapeBody& body);

}  // namespace piperun::sim
