#pragma once

#include <cstdint>
#include <vector>

#include "base/centreline.h"
#include "base/params.h"
#include "sim/script.h"
#include "sim/speed_profile.h"

namespace piperun::sim {

struct RollingParams {
  std::vector<double> vertices_m;  ///< rows of x, y
  double plane_z_m = 0;
  double corner_radius_m = 0.5;
  double speed_m_s = 0.5;
  double acceleration_time_s = 2;
  double rest_s = 1;
  double speed_modulation = 0;
  std::int64_t speed_modulation_cycles = 0;
  Vector3d yaw_pitch_roll_rad = Vector3d::Zero();

  void Visit(ParamVisitor& v);
};

/// A ball rolling without slip or pivoting on a horizontal plane along a closed polygon with rounded corners,
/// once round, from the middle of the edge between the first two vertices back to it; it rests before and
/// after.
///
/// Velocity v = s' t. No slip and no pivoting: w_W = z x v / r, so that v + w x (-r z) = 0. On a piece of
/// signed curvature k (positive to the left) this integrates in closed form: in axes (tangent, left, z) that
/// turn with the path the rotation rate per metre, (left / r - k z), is constant, hence over a distance d
///   R_WB = R_heading(d) Exp(d (y / r - k z)) R_heading(0)^T R_WB(0).
/// Speed modulation by a relative amplitude m, n cycles per round: s = S + m L / (2 pi n) (1 - cos(2 pi n S /
/// L)), S(t) the SpeedProfile over the round's length L. Where a straight meets a corner the path's
/// curvature, hence the acceleration, jumps, as it does for any line that consists of straights and arcs.
class RollingScript final : public Script {
 public:
  /// Throws InputError (keys rolling...) when there are fewer than three vertices, a corner does not fit or
  /// the way is too short for the acceleration.
  RollingScript(const RollingParams& params, double ball_radius_m);

  double duration_s() const override { return duration_s_; }
  ScriptPoint Eval(double t_s) const override;
  const std::vector<double>& knots_s() const override { return knots_s_; }
  bool contact() const override { return true; }
  double length_m() const { return profile_.distance_m(); }

 private:
  struct Piece {
    CentrelinePiece line;
    double curvature_1_m = 0;  ///< signed, positive to the left
    Quaterniond q_heading;     ///< of the tangent at the begin
    Quaterniond q_WB;          ///< at the begin
  };

  RollingScript(const RollingParams& params, double ball_radius_m, const std::vector<CentrelinePiece>& loop);
  void MakePieces(const std::vector<CentrelinePiece>& loop, const Quaterniond& q_WB);
  void MakeKnots();
  Quaterniond CalcAttitude(const Piece& piece, double distance_m) const;
  PathPoint EvalPath(double t_s) const;
  double FindTime(double s_m) const;  ///< when s_m > 0 has been covered
  const Piece& FindPiece(double s_m) const;

  double radius_m_;
  double rest_s_;
  double modulation_;
  SpeedProfile profile_;
  double modulation_1_m_;  ///< 2 pi n / L
  double duration_s_;
  std::vector<Piece> pieces_;
  std::vector<double> knots_s_;
};

}  // namespace piperun::sim
