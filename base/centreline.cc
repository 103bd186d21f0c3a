#include "base/centreline.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/check.h"
#include "base/number.h"

namespace piperun {
namespace {

constexpr double kMinTurn_rad = 1e-9;    // below this a vertex is no corner
constexpr double kMinReturn_rad = 1e-3;  // this close to half a turn there is no arc
constexpr double kSlack_m = 1e-9;        // arcs may meet end to end within rounding

/// A vertex of a polyline with what its bend costs the straights beside it.
struct Corner {
  double turn_rad = 0;          // of the arc in this line
  double tangent_length_m = 0;  // from the vertex to where the arc begins
  double radius_m = 0;
};

CentrelinePiece MakeLine(const Vector3d& p, const Vector3d& t, double length_m) {
  CentrelinePiece piece;
  piece.length_m = length_m;
  piece.p_begin_W = p;
  piece.tangent_begin_W = t;
  return piece;
}

CentrelinePiece MakeArc(const Vector3d& p, const Vector3d& t_in, const Vector3d& t_out, double turn_rad,
                        double radius_m) {
  CentrelinePiece piece = MakeLine(p, t_in, radius_m * turn_rad);
  piece.normal_begin_W = (t_out - t_out.dot(t_in) * t_in).normalized();
  piece.curvature_1_m = 1 / radius_m;
  return piece;
}

Corner MakeCorner(const Vector3d& t_in, const Vector3d& t_out, double radius_m, const std::string& name) {
  const double turn_rad = CalcTurn_rad(t_in, t_out);
  if (turn_rad < kMinTurn_rad) return {};
  if (turn_rad > std::numbers::pi - kMinReturn_rad)
    throw InputError("the line turns back on itself at " + name);
  if (!(radius_m > 0)) {
    throw InputError(FormatNumber(radius_m) + " m is not allowed as radius of the bend at " + name +
                     "; it must be > 0");
  }
  return {turn_rad, radius_m * std::tan(turn_rad / 2), radius_m};
}

Corner MakeCorner(const EndBend& bend) { return {bend.turn_rad, bend.tangent_length_m, bend.radius_m}; }

std::vector<Corner> MakeCorners(const Polyline& line, const LineBends& bends) {
  const std::size_t last = line.straights.size();
  Demand(bends.radius_m.size() + 1 == last, "every inner vertex has a radius");
  std::vector<Corner> corners{MakeCorner(bends.begin)};
  for (std::size_t i = 1; i < last; ++i) {
    corners.push_back(MakeCorner(line.straights[i - 1].tangent_W, line.straights[i].tangent_W,
                                 bends.radius_m[i - 1], CornerName(i, line.vertices_W[i])));
  }
  corners.push_back(MakeCorner(bends.end));
  return corners;
}

double FloorToMillimetre(double length_m) { return std::floor(1000 * length_m) / 1000; }

/// The bends at the two ends of straight `i` do not fit on it.
[[noreturn]] void RefuseBend(const Polyline& line, const std::vector<Corner>& corners, std::size_t i) {
  const std::size_t at = corners[i + 1].tangent_length_m > 0 ? i + 1 : i;
  const double length_m = line.straights[i].length_m, radius_m = corners[at].radius_m;
  const double needed_m = corners[i].tangent_length_m + corners[i + 1].tangent_length_m;
  throw InputError("a bend of radius " + FormatNumber(radius_m) + " m does not fit at " +
                   CornerName(at, line.vertices_W[at]) + ": the straight beside it is " +
                   FormatNumber(length_m) + " m long; the largest radius that fits there is " +
                   FormatNumber(FloorToMillimetre(radius_m * length_m / needed_m)) + " m");
}

/// What the bends leave of straight `i`; down to -kSlack_m.
double CalcFree_m(const Polyline& line, const std::vector<Corner>& corners, std::size_t i) {
  const double needed_m = corners[i].tangent_length_m + corners[i + 1].tangent_length_m;
  const double free_m = line.straights[i].length_m - needed_m;
  if (free_m < -kSlack_m) RefuseBend(line, corners, i);
  return free_m;
}

void Append(std::vector<CentrelinePiece>& pieces, CentrelinePiece piece) {
  piece.s_begin_m = pieces.empty() ? 0 : pieces.back().s_end_m();
  pieces.push_back(piece);
}

}  // namespace

CentrelinePoint EvalCentreline(const CentrelinePiece& piece, double s_m) {
  const double s = s_m - piece.s_begin_m;
  if (piece.straight()) {
    return {piece.p_begin_W + s * piece.tangent_begin_W, piece.tangent_begin_W, Vector3d::Zero()};
  }
  const double k = piece.curvature_1_m;
  const double c = std::cos(k * s), sn = std::sin(k * s);
  const Vector3d& t = piece.tangent_begin_W;
  const Vector3d& n = piece.normal_begin_W;
  return {piece.p_begin_W + (sn * t + (1 - c) * n) / k, c * t + sn * n, k * (c * n - sn * t)};
}

double FindNearest(const CentrelinePiece& piece, const Vector3d& p_W) {
  const Vector3d d = p_W - piece.p_begin_W;
  const double along = d.dot(piece.tangent_begin_W);
  if (piece.straight()) return piece.s_begin_m + along;
  const double radius = 1 / piece.curvature_1_m;
  const double inward = radius - d.dot(piece.normal_begin_W);
  const double mid = 0.5 * piece.length_m * piece.curvature_1_m;
  // angle measured from the middle of the arc, so that the cut of atan2 lies opposite to it
  const double c = std::cos(mid), s = std::sin(mid);
  const double angle = mid + std::atan2(along * c - inward * s, inward * c + along * s);
  return piece.s_begin_m + angle * radius;
}

CentrelinePiece Reversed(const CentrelinePiece& piece, double s_begin_m) {
  const CentrelinePoint end = EvalCentreline(piece, piece.s_end_m());
  CentrelinePiece r = piece;
  r.s_begin_m = s_begin_m;
  r.p_begin_W = end.p_W;
  r.tangent_begin_W = -end.tangent_W;
  if (!piece.straight()) r.normal_begin_W = end.curvature_W / piece.curvature_1_m;
  return r;
}

std::vector<CentrelinePiece> RoundCorners(const Polyline& line, const LineBends& bends) {
  const std::vector<Corner> corners = MakeCorners(line, bends);
  const std::vector<Straight>& straights = line.straights;
  std::vector<CentrelinePiece> pieces;
  const auto turn = [&](const Vector3d& p, const Vector3d& t_in, const Vector3d& t_out,
                        const Corner& corner) {
    return MakeArc(p, t_in, t_out, corner.turn_rad, corner.radius_m);
  };
  if (const Corner& begin = corners.front(); begin.turn_rad > 0) {
    // walked backwards, it begins on the straight
    const Vector3d& t = straights.front().tangent_W;
    const Vector3d p = line.vertices_W.front() + begin.tangent_length_m * t;
    Append(pieces, Reversed(turn(p, -t, -bends.begin.tangent_W, begin), 0));
  }
  for (std::size_t i = 0; i < straights.size(); ++i) {
    const Vector3d& t = straights[i].tangent_W;
    const Corner& end = corners[i + 1];
    const double free_m = CalcFree_m(line, corners, i);
    if (free_m > kSlack_m) {
      Append(pieces, MakeLine(line.vertices_W[i] + corners[i].tangent_length_m * t, t, free_m));
    }
    if (end.turn_rad == 0) continue;
    const bool last = i + 1 == straights.size();
    const Vector3d& t_out = last ? bends.end.tangent_W : straights[i + 1].tangent_W;
    Append(pieces, turn(line.vertices_W[i + 1] - end.tangent_length_m * t, t, t_out, end));
  }
  return pieces;
}

std::vector<CentrelinePiece> RoundCorners(const std::vector<Vector3d>& vertices, double bend_radius_m) {
  const Polyline line = MakePolyline(vertices);
  return RoundCorners(line, {std::vector<double>(vertices.size() - 2, bend_radius_m), {}, {}});
}

Polyline FitStraights(const Polyline& line, const LineBends& bends, double length_m) {
  const std::vector<Corner> corners = MakeCorners(line, bends);
  double arcs_m = 0, free_m = 0;
  for (const Corner& corner : corners) arcs_m += corner.radius_m * corner.turn_rad;
  for (std::size_t i = 0; i < line.straights.size(); ++i) free_m += CalcFree_m(line, corners, i);
  if (!(length_m > arcs_m && free_m > kSlack_m)) {
    throw InputError("its bends of together " + FormatNumber(arcs_m) + " m leave no straight of the stated " +
                     FormatNumber(length_m) + " m; give smaller bend radii");
  }
  const double k = (length_m - arcs_m) / free_m;
  Polyline fitted = line;
  for (std::size_t i = 0; i < line.straights.size(); ++i) {
    const double bends_m = corners[i].tangent_length_m + corners[i + 1].tangent_length_m;
    Straight& straight = fitted.straights[i];
    straight.length_m = bends_m + k * (straight.length_m - bends_m);
    fitted.vertices_W[i + 1] = fitted.vertices_W[i] + straight.length_m * straight.tangent_W;
  }
  return fitted;
}

}  // namespace piperun
