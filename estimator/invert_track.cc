#include "estimator/invert_track.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace piperun::estimator {
namespace {

constexpr double kVertical = 1e-3;    // sine of the angle to the vertical below which a pipe has no invert
constexpr double kSmooth_rad = 1e-6;  // turn below which one straight goes on in the next

/// Where an arc's tangent lies closest to a direction; its beginning for a line.
double ParallelPlace_m(const CentrelinePiece& line, const Vector3d& direction_W) {
  if (line.straight()) return line.s_begin_m;
  const double turn = std::atan2(direction_W.dot(line.normal_begin_W), direction_W.dot(line.tangent_begin_W));
  return line.s_begin_m + turn / line.curvature_1_m;
}

}  // namespace

InvertPoint InvertTrack::Eval(double chainage_m) {
  piece_ = route_.FindPiece(chainage_m, piece_);
  const RoutePiece& piece = route_.pieces()[piece_];
  const CentrelinePoint axis = EvalCentreline(piece.line, chainage_m);
  const Vector3d up = Vector3d::UnitZ() - axis.tangent_W.z() * axis.tangent_W;
  const double sine = up.norm();
  if (sine > kVertical) normal_W_ = up / sine;
  const bool lies = sine > kVertical;
  const double below_m = lies ? piece.RadiusAt_m(chainage_m) - ball_radius_m_ : 0;
  const double sinking = lies ? piece.taper : 0;
  return {axis.p_W - below_m * normal_W_, axis.tangent_W, normal_W_,
          std::hypot(1 + below_m * axis.curvature_W.dot(normal_W_), sinking)};
}

Vector3d InvertTrack::FindTangent(double chainage_m, double slack_m, const Vector3d& course_W) const {
  const double low_m = chainage_m - slack_m, high_m = chainage_m + slack_m;
  const std::size_t last = route_.FindPiece(high_m, piece_);
  Vector3d best = Vector3d::Zero();
  double best_dot = -std::numeric_limits<double>::infinity();
  for (std::size_t i = route_.FindPiece(low_m, piece_); i <= last; ++i) {
    const CentrelinePiece& line = route_.pieces()[i].line;
    const double begin_m = i > 0 ? std::max(low_m, line.s_begin_m) : low_m;
    const double end_m = i < last ? line.s_end_m() : high_m;
    const double s_m = std::clamp(ParallelPlace_m(line, course_W), begin_m, end_m);
    const Vector3d tangent_W = EvalCentreline(line, s_m).tangent_W;
    if (tangent_W.dot(course_W) > best_dot) {
      best = tangent_W;
      best_dot = tangent_W.dot(course_W);
    }
  }
  return best;
}

double InvertTrack::Project(const Vector3d& p_W, double near_m, double reach_m) const {
  double best_m = near_m;
  double best_distance = std::numeric_limits<double>::infinity();
  for (const RoutePiece& piece : route_.pieces()) {
    if (piece.line.s_end_m() < near_m - reach_m || piece.line.s_begin_m > near_m + reach_m) continue;
    const double s = std::clamp(FindNearest(piece.line, p_W), piece.line.s_begin_m, piece.line.s_end_m());
    const double distance = (EvalCentreline(piece.line, s).p_W - p_W).squaredNorm();
    if (distance < best_distance) {
      best_distance = distance;
      best_m = s;
    }
  }
  return best_m;
}

bool InvertTrack::StraightAround(double chainage_m, double margin_m) {
  piece_ = route_.FindPiece(chainage_m, piece_);
  const Vector3d& tangent_W = route_.pieces()[piece_].line.tangent_begin_W;
  const std::size_t last = route_.FindPiece(chainage_m + margin_m, piece_);
  for (std::size_t i = route_.FindPiece(chainage_m - margin_m, piece_); i <= last; ++i) {
    const CentrelinePiece& line = route_.pieces()[i].line;
    if (!line.straight() || CalcTurn_rad(tangent_W, line.tangent_begin_W) > kSmooth_rad) return false;
  }
  return true;
}

}  // namespace piperun::estimator
