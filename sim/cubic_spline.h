#pragma once

#include <vector>

#include "base/pose.h"

namespace piperun::sim {

/// Value and time derivatives of a vector curve, in the unit of its points.
struct SplinePoint {
  Vector3d x;
  Vector3d dx;
  Vector3d ddx;
};

/// C2 cubic spline through timed points with true stops: it begins and ends at rest, and between two
/// consecutive *equal* points it does not move at all.
///
/// Each moving stretch between stops is one cubic spline whose first and second derivative vanish at both
/// ends. The two degrees of freedom this needs come from two free knots, in the middle of its first and of
/// its last interval (at its thirds when it has only one), where only smoothness is asked (Biagiotti &
/// Melchiorri, Trajectory Planning for Automatic Machines and Robots, 2008, section 4.4.4). The piece next to
/// a stop is then a pure cubic of the time from it: straight, monotone, without overshoot.
class CubicSpline {
 public:
  /// `times_s` strictly increasing, from zero; as many points, at least one (checked by the caller).
  CubicSpline(const std::vector<double>& times_s, const std::vector<Vector3d>& points);

  /// At rest at the last point after the last time.
  SplinePoint Eval(double t_s) const;
  /// Where pieces begin, and the end.
  const std::vector<double>& knots_s() const { return knots_s_; }

 private:
  struct Piece {  // x + v T + a T^2/2 + j T^3/6
    Vector3d x, v, a, j;
  };

  void AppendRest(double begin_s, const Vector3d& x);
  void AppendStretch(std::vector<double> times_s, std::vector<Vector3d> points);

  std::vector<double> knots_s_;
  std::vector<Piece> pieces_;  // piece i begins at knots_s_[i]; the last is at rest
};

}  // namespace piperun::sim
