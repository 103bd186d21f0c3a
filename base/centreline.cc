#include "base/centreline.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/check.h"
#include "base/number.h"

namespace piperun {
namespace {

constexpr double kMinEdge_m = 1e-6;
constexpr double kMinTurn_rad = 1e-9;    // below this a vertex is no corner
constexpr double kMinReturn_rad = 1e-3;  // this close to half a turn there is no arc
constexpr double kSlack_m = 1e-9;        // arcs may meet end to end within rounding

/// One straight of a polyline, vertex to vertex.
struct Edge {
  Vector3d tangent;
  double length_m = 0;
};

/// What one vertex of a polyline costs its two edges.
struct Corner {
  double turn_rad = 0;
  double tangent_length_m = 0;  // R tan(turn/2): from the vertex to where the arc begins
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

std::string CornerName(std::size_t i, const Vector3d& p) {
  return "corner " + std::to_string(i) + " at [" + FormatNumber(p.x()) + ", " + FormatNumber(p.y()) + ", " +
         FormatNumber(p.z()) + "]";
}

std::vector<Edge> MakeEdges(const std::vector<Vector3d>& vertices) {
  std::vector<Edge> edges;
  for (std::size_t i = 0; i + 1 < vertices.size(); ++i) {
    const Vector3d d = vertices[i + 1] - vertices[i];
    const double length_m = d.norm();
    if (!(length_m > kMinEdge_m)) {
      throw InputError("two neighbouring vertices coincide (" + CornerName(i + 1, vertices[i + 1]) +
                       "); a straight needs a length above " + FormatNumber(kMinEdge_m) + " m");
    }
    edges.push_back({d / length_m, length_m});
  }
  return edges;
}

Corner MakeCorner(const Vector3d& t_in, const Vector3d& t_out, double radius_m, const std::string& name) {
  const double turn_rad = std::atan2(t_in.cross(t_out).norm(), t_in.dot(t_out));
  if (turn_rad < kMinTurn_rad) return {};
  if (turn_rad > std::numbers::pi - kMinReturn_rad)
    throw InputError("the line turns back on itself at " + name);
  if (!(radius_m > 0)) {
    throw InputError(FormatNumber(radius_m) + " m is not allowed as radius of the bend at " + name +
                     "; it must be > 0");
  }
  return {turn_rad, radius_m * std::tan(turn_rad / 2)};
}

/// The corners of a polyline; its first and last vertex cost nothing.
std::vector<Corner> MakeCorners(const std::vector<Vector3d>& vertices, const std::vector<Edge>& edges,
                                double radius_m) {
  std::vector<Corner> corners(vertices.size());
  for (std::size_t i = 1; i < edges.size(); ++i) {
    corners[i] = MakeCorner(edges[i - 1].tangent, edges[i].tangent, radius_m, CornerName(i, vertices[i]));
  }
  return corners;
}

double FloorToMillimetre(double length_m) { return std::floor(1000 * length_m) / 1000; }

[[noreturn]] void RefuseBend(const std::string& corner, double edge_length_m, double needed_m,
                             double radius_m) {
  throw InputError("a bend of radius " + FormatNumber(radius_m) + " m does not fit at " + corner +
                   ": the straight beside it is " + FormatNumber(edge_length_m) +
                   " m long; the largest radius that fits there is " +
                   FormatNumber(FloorToMillimetre(radius_m * edge_length_m / needed_m)) + " m");
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

std::vector<CentrelinePiece> RoundCorners(const std::vector<Vector3d>& vertices, double bend_radius_m) {
  Demand(vertices.size() >= 2, "a polyline has at least two vertices");
  const std::vector<Edge> edges = MakeEdges(vertices);
  const std::vector<Corner> corners = MakeCorners(vertices, edges, bend_radius_m);
  std::vector<CentrelinePiece> pieces;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const Edge& edge = edges[i];
    const Corner &begin = corners[i], &end = corners[i + 1];
    const double needed_m = begin.tangent_length_m + end.tangent_length_m;
    const double free_m = edge.length_m - needed_m;
    if (free_m < -kSlack_m) {
      const std::size_t at = i + 1 < edges.size() ? i + 1 : i;
      RefuseBend(CornerName(at, vertices[at]), edge.length_m, needed_m, bend_radius_m);
    }
    if (free_m > kSlack_m) {
      Append(pieces, MakeLine(vertices[i] + begin.tangent_length_m * edge.tangent, edge.tangent, free_m));
    }
    if (end.turn_rad > 0) {
      const Vector3d p_begin = vertices[i + 1] - end.tangent_length_m * edge.tangent;
      Append(pieces, MakeArc(p_begin, edge.tangent, edges[i + 1].tangent, end.turn_rad, bend_radius_m));
    }
  }
  return pieces;
}

}  // namespace piperun
