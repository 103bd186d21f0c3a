#pragma once

#include <vector>

#include "sim/route_spot.h"

namespace piperun::sim {

/// Contact of a sphere with the wall, in the frame F of the piece it is in.
struct WallContact {
  Vector3d normal_F;  ///< unit, from the wall to the sphere
  double gap_m = 0;   ///< between the sphere and the wall where the sphere is about to be; negative: overlap
  bool near = false;  ///< the sphere would come within kContactRange_m this step
};

/// The bore's wall along a route, exact: a cylinder around every straight piece, a torus around every bend.
///
/// Every piece has its own frame F, so that the wall is found from the small coordinates across the pipe and
/// rounding does not grow with the distance from the origin of W. On a straight, F sits at its beginning with
/// x along the axis; in a bend, at the bend's centre with z normal to its plane and the bend beginning on x.
class TubeWall {
 public:
  static constexpr double kContactRange_m = 0.002;

  /// Keeps a reference to the route.
  explicit TubeWall(const Route& route);

  const Pose& X_WF(std::size_t piece) const { return pieces_[piece].X_WF; }
  const Pose& X_FW(std::size_t piece) const { return pieces_[piece].X_FW; }

  /// Contact of a sphere at p_F, moving with v_F, over the coming step dt, as a constraint on positions (like
  /// SHAKE):
  ///
  ///   v_t = v - n (v . n),  p' = p + v_t dt,  gap = R - r - |offset of p' from the axis|
  ///
  /// n taken at p. A contact that makes the normal velocity -gap/dt puts the sphere on the curved wall at the
  /// end of the step, where the tangent at p would leave it; so position and velocity agree. Looks at the
  /// pieces next along the route where the step crosses a joint, and at no others.
  WallContact Probe(const RouteSpot& spot, const Vector3d& p_F, const Vector3d& v_F, double radius_m,
                    double dt_s) const;

 private:
  struct Piece {
    Pose X_WF, X_FW;
    double bore_radius_m = 0;
    double bend_radius_m = 0;  // 0 on a straight
  };
  static Piece MakePiece(const RoutePiece& piece);
  static Vector3d CalcOffset(const Piece& piece, const Vector3d& p_F);
  double CalcGap(const RouteSpot& spot, const Vector3d& p_F, double travel_m, double radius_m) const;

  const Route& route_;
  std::vector<Piece> pieces_;
};

}  // namespace piperun::sim
