#include "base/centreline.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/check.h"
#include "base/number.h"

namespace piperun {
namespace {

constexpr double kMinTurn_rad = 1e-9;  // below this a vertex is no corner
constexpr double kSlack_m = 1e-9;      // arcs may meet end to end within rounding

/// What one vertex of a polyline costs its two edges.
struct Corner {
  double turn_rad = 0;
  double tangent_length_m = 0;  // R tan(turn/2): from the vertex to where the arc begins
};

Corner MakeCorner(const Vector3d& t_in, const Vector3d& t_out, double radius_m) {
  const double turn = std::atan2(t_in.cross(t_out).norm(), t_in.dot(t_out));
  if (turn < kMinTurn_rad) return {};
  return {turn, radius_m * std::tan(turn / 2)};
}

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

std::string CornerName(std::size_t i, const Vector3d& p) {
  return "corner " + std::to_string(i) + " at [" + FormatNumber(p.x()) + ", " + FormatNumber(p.y()) + ", " +
         FormatNumber(p.z()) + "]";
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

std::vector<CentrelinePiece> RoundCorners(const std::vector<Vector3d>& vertices, double bend_radius_m) {
  Demand(vertices.size() >= 2, "a polyline has at least two vertices");
  const std::size_t edges = vertices.size() - 1;
  std::vector<Vector3d> tangent(edges);
  std::vector<double> length(edges);
  for (std::size_t i = 0; i < edges; ++i) {
    const Vector3d d = vertices[i + 1] - vertices[i];
    length[i] = d.norm();
    if (!(length[i] > 1e-6)) {
      throw InputError("two neighbouring vertices coincide (" + CornerName(i + 1, vertices[i + 1]) +
                       "); a pipe needs a length above 1e-6 m");
    }
    tangent[i] = d / length[i];
  }
  std::vector<Corner> corner(vertices.size());
  for (std::size_t i = 1; i < edges; ++i) {
    corner[i] = MakeCorner(tangent[i - 1], tangent[i], bend_radius_m);
    if (corner[i].turn_rad > std::numbers::pi - 1e-3) {
      throw InputError("the line turns back on itself at " + CornerName(i, vertices[i]));
    }
  }

  std::vector<CentrelinePiece> pieces;
  const auto append = [&pieces](CentrelinePiece piece) {
    piece.s_begin_m = pieces.empty() ? 0 : pieces.back().s_end_m();
    pieces.push_back(piece);
  };
  for (std::size_t i = 0; i < edges; ++i) {
    const double free_m = length[i] - corner[i].tangent_length_m - corner[i + 1].tangent_length_m;
    if (free_m < -kSlack_m) {
      const double needed = corner[i].tangent_length_m + corner[i + 1].tangent_length_m;
      throw InputError("a bend of radius " + FormatNumber(bend_radius_m) + " m does not fit at " +
                       CornerName(i + 1 < edges ? i + 1 : i, vertices[i + 1 < edges ? i + 1 : i]) +
                       ": the straight beside it is " + FormatNumber(length[i]) +
                       " m long; the largest radius that fits is " +
                       FormatNumber(bend_radius_m * length[i] / needed) + " m");
    }
    if (free_m > kSlack_m) {
      append(MakeLine(vertices[i] + corner[i].tangent_length_m * tangent[i], tangent[i], free_m));
    }
    if (corner[i + 1].turn_rad > 0) {
      const Vector3d begin = vertices[i + 1] - corner[i + 1].tangent_length_m * tangent[i];
      append(MakeArc(begin, tangent[i], tangent[i + 1], corner[i + 1].turn_rad, bend_radius_m));
    }
  }
  return pieces;
}

}  // namespace piperun
