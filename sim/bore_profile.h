#pragma once

#include <vector>

#include "sim/bore.h"
#include "sim/wall_foot.h"

namespace piperun::sim {

/// A point in a pipe as its wall sees it, in any one frame: `tangent` of the axis next to it, unit vector
/// `out` from the axis to it (any across the pipe when it lies on the axis), `offset_m` >= 0 along `out`.
struct PipePoint {
  double s_m = 0;
  double offset_m = 0;
  Vector3d tangent;
  Vector3d out;
};

/// The bore radius along a pipe: straight lines over s, in the (s, rho) half-plane, with the cones of the
/// pipe and of its neighbours behind smooth joints (sim/bore.h). Behind other ends, the profile stops.
///
/// A line of slope m = dR/ds is a cylinder or a cone: its wall is met along the normal (m, -1)/sqrt(1 + m^2)
/// in (s, rho). Where the slope rises along s, the wall's edge points into the water and the ball rolls over
/// it; where it falls, both walls may touch at once. Exact where the axis is straight as far as the ball
/// touches; in a bend exact for a cylinder (a torus), and for a cone up to its slope times ball radius over
/// bend radius.
class BoreProfile {
 public:
  BoreProfile(const Bore& bore, int pipe);

  /// The radius is the same everywhere from a to b, and neither end of the profile lies between.
  bool IsUniform(double a_m, double b_m) const;

  /// Adds the feet of a point on the walls at most `limit_m` along the pipe away; when the wall opposite is
  /// less than `ring_m` farther, also those 120 degrees around a cone or an edge: a ball that jams there
  /// touches it all around.
  void AddFeet(const PipePoint& p, double limit_m, double ring_m, WallFeet& feet) const;

 private:
  struct Vertex {
    double s_m = 0;
    double radius_m = 0;
  };
  void AddNeighbour(const Bore& bore, int pipe, bool at_to);
  double Slope(std::size_t segment) const;
  bool Holds(std::size_t segment, double s_m) const;
  void AddSegmentFeet(const PipePoint& p, std::size_t segment, double ring_m, WallFeet& feet) const;
  void AddEdgeFeet(const PipePoint& p, std::size_t vertex, double ring_m, WallFeet& feet) const;

  std::vector<Vertex> vertices_;                // s rises
  bool open_begin_ = false, open_end_ = false;  // the first, the last line goes on without end
};

}  // namespace piperun::sim
