#include "sim/rolling_script.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/check.h"
#include "base/number.h"
#include "sim/yaw_pitch_roll.h"

namespace piperun::sim {
namespace {

/// Centre line of the ball, from the middle of the first edge once round.
std::vector<CentrelinePiece> MakeLoop(const RollingParams& p, double z_m) {
  std::vector<Vector3d> corners;
  for (std::size_t i = 0; i + 1 < p.vertices_m.size(); i += 2) {
    corners.emplace_back(p.vertices_m[i], p.vertices_m[i + 1], z_m);
  }
  if (corners.size() < 3)
    throw InputError("a closed polygon needs at least three vertices", "rolling.vertices_m");
  const Vector3d start = 0.5 * (corners[0] + corners[1]);
  std::vector<Vector3d> line{start};
  line.insert(line.end(), corners.begin() + 1, corners.end());
  line.insert(line.end(), {corners.front(), start});
  try {
    return RoundCorners(line, p.corner_radius_m);
  } catch (const InputError& e) {
    throw InputError(e.problem() + " (corners are counted from the start in the middle of the first edge)",
                     "rolling.vertices_m");
  }
}

SpeedProfile MakeProfile(const RollingParams& p, double length_m) {
  if (!SpeedProfile::Fits(length_m, p.speed_m_s, p.acceleration_time_s)) {
    throw InputError("the way of " + FormatNumber(length_m) + " m is too short to reach " +
                         FormatNumber(p.speed_m_s) + " m/s within " + FormatNumber(p.acceleration_time_s) +
                         " s and to stop again; at most " + FormatNumber(length_m / p.speed_m_s) +
                         " s is possible",
                     "rolling.acceleration_time_s");
  }
  return SpeedProfile(length_m, p.speed_m_s, p.acceleration_time_s);
}

Quaterniond CalcHeading(const Vector3d& tangent) {
  return ExpSO3(std::atan2(tangent.y(), tangent.x()) * Vector3d::UnitZ());
}

}  // namespace

void RollingParams::Visit(ParamVisitor& v) {
  v.Table({"vertices_m", "Rows of x, y: the corners of the closed polygon."}, Range::Any(), 2, vertices_m);
  v.Number({"plane_z_m", "Height of the plane the ball rolls on."}, Range::Any(), plane_z_m);
  v.Number({"corner_radius_m", "Radius of the rounded corners."}, Range::Positive(), corner_radius_m);
  v.Number({"speed_m_s", "Cruising speed of the centre."}, Range::Positive(), speed_m_s);
  v.Number({"acceleration_time_s", "Time from rest to cruise and from cruise to rest."}, Range::Positive(),
           acceleration_time_s);
  v.Number({"rest_s", "Time at rest before and after."}, Range::NonNegative(), rest_s);
  v.Number({"speed_modulation", "Relative amplitude of the speed's variation along the way."},
           Range::Between(0, 0.9), speed_modulation);
  v.Integer({"speed_modulation_cycles", "Cycles of the speed's variation per round."}, 0, 100000,
            speed_modulation_cycles);
  v.Vector({"yaw_pitch_roll_rad", "Attitude at the start: R_WB = Rz(yaw) Ry(pitch) Rx(roll)."}, Range::Any(),
           yaw_pitch_roll_rad);
}

RollingScript::RollingScript(const RollingParams& p, double ball_radius_m)
    : RollingScript(p, ball_radius_m, MakeLoop(p, p.plane_z_m + ball_radius_m)) {}

RollingScript::RollingScript(const RollingParams& p, double ball_radius_m,
                             const std::vector<CentrelinePiece>& loop)
    : radius_m_(ball_radius_m),
      rest_s_(p.rest_s),
      modulation_(p.speed_modulation_cycles > 0 ? p.speed_modulation : 0),
      profile_(MakeProfile(p, loop.back().s_end_m())),
      modulation_1_m_(2 * std::numbers::pi * static_cast<double>(p.speed_modulation_cycles) / length_m()),
      duration_s_(profile_.duration_s() + 2 * rest_s_) {
  MakePieces(loop, sim::CalcAttitude(p.yaw_pitch_roll_rad));
  MakeKnots();
}

void RollingScript::MakePieces(const std::vector<CentrelinePiece>& loop, const Quaterniond& q_WB) {
  Quaterniond q = q_WB;
  for (const CentrelinePiece& line : loop) {
    const double turn = line.tangent_begin_W.cross(line.normal_begin_W).z();
    pieces_.push_back({line, std::copysign(line.curvature_1_m, turn), CalcHeading(line.tangent_begin_W), q});
    q = CalcAttitude(pieces_.back(), line.length_m).normalized();
  }
}

void RollingScript::MakeKnots() {
  const double ramp_s = profile_.ramp_s();
  knots_s_ = {rest_s_, rest_s_ + ramp_s, duration_s_ - rest_s_ - ramp_s, duration_s_ - rest_s_};
  for (std::size_t i = 1; i < pieces_.size(); ++i) knots_s_.push_back(FindTime(pieces_[i].line.s_begin_m));
  std::sort(knots_s_.begin(), knots_s_.end());
}

double RollingScript::FindTime(double s_m) const {
  double low = rest_s_, high = duration_s_ - rest_s_;
  for (double t = 0.5 * (low + high); t > low && t < high; t = 0.5 * (low + high)) {
    (EvalPath(t).s_m < s_m ? low : high) = t;
  }
  return high;
}

PathPoint RollingScript::EvalPath(double t_s) const {
  const PathPoint S = profile_.Eval(t_s - rest_s_);
  if (modulation_ == 0) return S;
  const double phase = modulation_1_m_ * S.s_m;
  const double stretch = 1 + modulation_ * std::sin(phase);  // ds/dS
  return {S.s_m + modulation_ / modulation_1_m_ * (1 - std::cos(phase)), stretch * S.v_m_s,
          stretch * S.a_m_s2 + modulation_ * modulation_1_m_ * std::cos(phase) * S.v_m_s * S.v_m_s};
}

const RollingScript::Piece& RollingScript::FindPiece(double s_m) const {
  const auto after = std::upper_bound(pieces_.begin() + 1, pieces_.end(), s_m,
                                      [](double s, const Piece& piece) { return s < piece.line.s_begin_m; });
  return *(after - 1);
}

Quaterniond RollingScript::CalcAttitude(const Piece& piece, double d) const {
  const Quaterniond turn_W = ExpSO3(piece.curvature_1_m * d * Vector3d::UnitZ());
  const Quaterniond roll = ExpSO3(Vector3d(0, d / radius_m_, -piece.curvature_1_m * d));
  return turn_W * piece.q_heading * roll * piece.q_heading.conjugate() * piece.q_WB;
}

ScriptPoint RollingScript::Eval(double t_s) const {
  const PathPoint path = EvalPath(t_s);
  const Piece& piece = FindPiece(path.s_m);
  const CentrelinePoint line = EvalCentreline(piece.line, path.s_m);
  ScriptPoint point;
  point.X_WB = {line.p_W, CalcAttitude(piece, path.s_m - piece.line.s_begin_m)};
  point.v_WB_W = path.v_m_s * line.tangent_W;
  point.a_WB_W = path.a_m_s2 * line.tangent_W + path.v_m_s * path.v_m_s * line.curvature_W;
  point.w_WB_B = point.X_WB.q.conjugate() * (Vector3d::UnitZ().cross(point.v_WB_W) / radius_m_);
  return point;
}

}  // namespace piperun::sim
