#include "sim/tube_wall.h"

#include <cmath>

namespace piperun::sim {
namespace {

constexpr double kOnAxis_m = 1e-9;  // closer, no wall is nearest

Pose MakeFrame(const Vector3d& origin_W, const Vector3d& x_W, const Vector3d& y_W) {
  Matrix3d R_WF;
  R_WF << x_W, y_W, x_W.cross(y_W);
  return {origin_W, Quaterniond(R_WF).normalized()};
}

}  // namespace

TubeWall::TubeWall(const Route& route) : route_(route) {
  for (const RoutePiece& piece : route.pieces()) pieces_.push_back(MakePiece(piece));
}

TubeWall::Piece TubeWall::MakePiece(const RoutePiece& piece) {
  const CentrelinePiece& line = piece.line;
  Piece p;
  p.bore_radius_m = piece.radius_m;
  if (line.straight()) {
    p.X_WF = MakeFrame(line.p_begin_W, line.tangent_begin_W, line.tangent_begin_W.unitOrthogonal());
  } else {
    p.bend_radius_m = 1 / line.curvature_1_m;
    const Vector3d centre_W = line.p_begin_W + p.bend_radius_m * line.normal_begin_W;
    p.X_WF = MakeFrame(centre_W, -line.normal_begin_W, line.tangent_begin_W);
  }
  p.X_FW = p.X_WF.Inverse();
  return p;
}

Vector3d TubeWall::CalcOffset(const Piece& piece, const Vector3d& p_F) {
  if (piece.bend_radius_m == 0) return {0, p_F.y(), p_F.z()};
  const double rho = std::sqrt(p_F.x() * p_F.x() + p_F.y() * p_F.y());
  const double outward = (rho - piece.bend_radius_m) / rho;
  return {outward * p_F.x(), outward * p_F.y(), p_F.z()};
}

/// Gap at p_F, where a step of `travel_m` from `spot` has led.
double TubeWall::CalcGap(const RouteSpot& spot, const Vector3d& p_F, double travel_m, double radius_m) const {
  const CentrelinePiece& line = route_.pieces()[spot.piece].line;
  const bool crosses =
      spot.chainage_m - travel_m < line.s_begin_m || spot.chainage_m + travel_m > line.s_end_m();
  const Piece* piece = &pieces_[spot.piece];
  Vector3d p = p_F;
  if (crosses) {
    const Vector3d p_W = piece->X_WF * p_F;
    const std::size_t next = FindRouteSpot(route_, p_W, spot.piece).piece;
    if (next != spot.piece) {
      piece = &pieces_[next];
      p = piece->X_FW * p_W;
    }
  }
  return piece->bore_radius_m - radius_m - CalcOffset(*piece, p).norm();
}

WallContact TubeWall::Probe(const RouteSpot& spot, const Vector3d& p_F, const Vector3d& v_F, double radius_m,
                            double dt_s) const {
  const Piece& piece = pieces_[spot.piece];
  Vector3d offset = CalcOffset(piece, p_F);
  // from the axis, where no wall is nearest, the sphere is about to meet the one it moves to
  if (offset.norm() < kOnAxis_m) offset = CalcOffset(piece, p_F + dt_s * v_F);
  if (offset.norm() < kOnAxis_m) return {};
  WallContact contact;
  contact.normal_F = -offset.normalized();
  const double v_n = v_F.dot(contact.normal_F);
  const Vector3d step_F = (v_F - v_n * contact.normal_F) * dt_s;
  // a bend's inner side is shorter than its axis: twice the step bounds the chainage covered (D < R_c)
  contact.gap_m = CalcGap(spot, p_F + step_F, 2 * step_F.norm(), radius_m);
  contact.near = contact.gap_m + v_n * dt_s < kContactRange_m;
  return contact;
}

}  // namespace piperun::sim
