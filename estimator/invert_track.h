#pragma once

#include "estimator/estimator.h"

namespace piperun::estimator {

/// A ball lying on the invert of the mapped pipe at some chainage.
struct InvertPoint {
  Vector3d p_W;        ///< of the ball's centre
  Vector3d tangent_W;  ///< direction of travel
  Vector3d normal_W;   ///< from the contact to the ball's centre: up, made perpendicular to the tangent
  double stretch = 1;  ///< path of the ball's centre per metre of centreline
};

/// Where a ball of given radius r runs along a route: a distance d = R(s) - r below the axis, R the bore's
/// radius. Per metre of centreline with curvature vector kappa its centre travels
///
///   sqrt((1 + d kappa . n)^2 + (dR/ds)^2)
///
/// At a sharp corner direction and, on a slope, position change at once. Keeps the map by reference;
/// remembers the piece it was last asked about.
class InvertTrack {
 public:
  InvertTrack(const RouteMap& map, double ball_radius_m) : route_(map.route), ball_radius_m_(ball_radius_m) {}

  /// Beyond the route's ends its first and last piece go on. In a vertical pipe there is no invert: the
  /// normal stays what it was and the ball is taken to the axis.
  InvertPoint Eval(double chainage_m);
  /// The tangent within `slack_m` of a chainage that lies closest to a course: what the ball really follows
  /// when the chainage is a little wrong and a bend is near.
  Vector3d FindTangent(double chainage_m, double slack_m, const Vector3d& course_W) const;
  /// Chainage of the point of the route nearest to p, searched on the pieces within `reach_m` of `near_m`.
  double Project(const Vector3d& p_W, double near_m, double reach_m) const;
  /// True when the route runs in one direction for `margin_m` on both sides: no bend, no sharp corner.
  bool StraightAround(double chainage_m, double margin_m);

 private:
  const Route& route_;
  double ball_radius_m_;
  std::size_t piece_ = 0;
  Vector3d normal_W_ = Vector3d::UnitZ();
};

}  // namespace piperun::estimator
