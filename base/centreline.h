#pragma once

#include <vector>

#include "base/polyline.h"

namespace piperun {

/// A point of a centreline: position, unit tangent and curvature vector (towards the bend's centre, length
/// 1/R; zero on a straight).
struct CentrelinePoint {
  Vector3d p_W;
  Vector3d tangent_W;
  Vector3d curvature_W;
};

/// One piece of a pipe's centreline: a straight line, or a circular arc when curvature_1_m > 0. Consecutive
/// pieces share position and tangent.
struct CentrelinePiece {
  double s_begin_m = 0;
  double length_m = 0;
  Vector3d p_begin_W = Vector3d::Zero();
  Vector3d tangent_begin_W = Vector3d::UnitX();
  Vector3d normal_begin_W = Vector3d::Zero();  ///< unit, towards the bend's centre; zero on a straight
  double curvature_1_m = 0;

  double s_end_m() const { return s_begin_m + length_m; }
  bool straight() const { return curvature_1_m == 0; }
};

/// Point at distance s (same origin as s_begin_m). Beyond its ends a piece goes on as line or arc.
CentrelinePoint EvalCentreline(const CentrelinePiece& piece, double s_m);

/// Distance s of the point of the (extended) piece nearest to p. On an arc the half turn either side of its
/// middle is searched; a point on the bend's axis has no nearest point and returns the middle.
double FindNearest(const CentrelinePiece& piece, const Vector3d& p_W);

/// The same piece walked from its end to its beginning, starting at s_begin_m.
CentrelinePiece Reversed(const CentrelinePiece& piece, double s_begin_m);

/// The part of a bend that belongs to a line's first or last straight, where the line goes over into another
/// one: an arc from `tangent_W`, the line's direction at its very end, into the straight.
struct EndBend {
  double radius_m = 0;
  double turn_rad = 0;          ///< of this part; 0: the bend lies beyond the line's end
  double tangent_length_m = 0;  ///< R tan(theta/2) of the whole bend: what it takes from the straight
  Vector3d tangent_W = Vector3d::Zero();
};

/// How the corners of a polyline are rounded.
struct LineBends {
  std::vector<double> radius_m;  ///< at each inner vertex
  EndBend begin, end;
};

/// The line with its corners rounded, tangent at both ends of every arc: a corner that turns by theta begins
/// R tan(theta/2) before its vertex and is R theta long. Throws InputError when the line turns back on
/// itself, the radius of a corner is not > 0, or an arc does not fit between its neighbours (the message
/// names the corner and the largest radius that fits).
std::vector<CentrelinePiece> RoundCorners(const Polyline& line, const LineBends& bends);

/// The same for the polyline through `vertices` with one radius everywhere; two vertices that coincide are an
/// InputError, too.
std::vector<CentrelinePiece> RoundCorners(const std::vector<Vector3d>& vertices, double bend_radius_m);

/// The line with all straights between its bends made longer or shorter by one factor, so that the rounded
/// line has the length L:
///
///   sum arcs + k sum (l_i - T_i - T_{i+1}) = L        T: tangent lengths
///
/// Directions and arcs stay; the line begins where it did. Throws InputError when no straight is left for it.
Polyline FitStraights(const Polyline& line, const LineBends& bends, double length_m);

}  // namespace piperun
