#include "sim/walk_script.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/check.h"
#include "base/number.h"
#include "sim/speed_profile.h"

namespace piperun::sim {
namespace {

constexpr double kMaxSpacing_s = 0.05;
constexpr double kSpacingsPerWobble = 24;
constexpr double kMinHorizontal = 0.01;  // horizontal part of a chord that still has a heading

/// The rows of the walk, in the making.
class WalkRows {
 public:
  WalkRows(const WalkParams& params, const Route& route) : params_(params), route_(route) {
    const double length = route.length_m();
    const double legs = params.leg_length_m ? std::ceil(length / *params.leg_length_m - 1e-9) : 1;
    const double leg_m = length / legs;
    if (!SpeedProfile::Fits(leg_m, params.speed_m_s, params.acceleration_time_s)) {
      throw InputError("a leg of " + FormatNumber(leg_m) + " m is too short to reach " +
                           FormatNumber(params.speed_m_s) + " m/s and to stop again; at most " +
                           FormatNumber(leg_m / params.speed_m_s) + " s is possible",
                       "walk.acceleration_time_s");
    }
    AppendPose(0, 0, 0);
    AppendRest(params.rest_s);
    for (int leg = 0; leg < static_cast<int>(legs); ++leg) {
      if (leg > 0) AppendRest(params.stop_s);
      AppendLeg(leg * leg_m, SpeedProfile(leg_m, params.speed_m_s, params.acceleration_time_s));
    }
    AppendRest(params.rest_s);
  }

  WaypointScript MakeScript() const { return WaypointScript(times_s_, positions_m_, angles_rad_); }

 private:
  /// `effort`: speed over walking speed.
  void AppendPose(double t_s, double s_m, double effort) {
    const double stride = std::numbers::pi * params_.wobble_Hz * t_s;  // half the phase of a step
    const double bob_m = effort * params_.wobble_m * std::sin(2 * stride);
    times_s_.push_back(t_s);
    positions_m_.push_back(route_.Eval(s_m).p_W + Vector3d(0, 0, params_.height_m + bob_m));
    angles_rad_.emplace_back(CalcYaw(s_m), effort * params_.wobble_rad * std::cos(2 * stride),
                             effort * params_.wobble_rad * std::sin(stride));
  }

  void AppendRest(double duration_s) {
    if (duration_s == 0) return;
    times_s_.push_back(times_s_.back() + duration_s);
    positions_m_.push_back(positions_m_.back());
    angles_rad_.push_back(angles_rad_.back());
  }

  void AppendLeg(double s_begin_m, const SpeedProfile& profile) {
    const double begin_s = times_s_.back();
    const double T = profile.duration_s();
    double spacing_s = kMaxSpacing_s;
    if (params_.wobble_m > 0 || params_.wobble_rad > 0) {
      spacing_s = std::min(spacing_s, 1 / (kSpacingsPerWobble * params_.wobble_Hz));
    }
    const int n = static_cast<int>(std::ceil(T / spacing_s));
    for (int i = 1; i < n; ++i) {
      const double t = T * i / n;
      const PathPoint path = profile.Eval(t);
      AppendPose(begin_s + t, s_begin_m + path.s_m, path.v_m_s / params_.speed_m_s);
    }
    AppendPose(begin_s + T, s_begin_m + profile.distance_m(), 0);
  }

  /// Continuous from pose to pose.
  double CalcYaw(double s_m) const {
    const double half_m = 0.5 * params_.speed_m_s * params_.turn_time_s;
    const Vector3d chord = route_.Eval(s_m + half_m).p_W - route_.Eval(s_m - half_m).p_W;
    if (std::hypot(chord.x(), chord.y()) < kMinHorizontal * 2 * half_m) {
      throw InputError("the route has no horizontal direction to walk in near chainage " + FormatNumber(s_m) +
                           " m; use a script of waypoints there or a shorter turn time",
                       "walk.turn_time_s");
    }
    const double yaw = std::atan2(chord.y(), chord.x());
    if (angles_rad_.empty()) return yaw;
    const double before = angles_rad_.back().x();
    return before + std::remainder(yaw - before, 2 * std::numbers::pi);
  }

  const WalkParams& params_;
  const Route& route_;
  std::vector<double> times_s_;
  std::vector<Vector3d> positions_m_;
  std::vector<Vector3d> angles_rad_;
};

}  // namespace

void WalkParams::Visit(ParamVisitor& v) {
  v.Number({"speed_m_s", "Walking speed."}, Range::Positive(), speed_m_s);
  v.Number({"acceleration_time_s", "Time from rest to walking speed and back."}, Range::Positive(),
           acceleration_time_s);
  v.NumberOr({"leg_length_m", "Stops are at most this far apart (legs are equal); none: no stops."},
             Range::Positive(), "none", leg_length_m);
  v.Number({"stop_s", "Length of a stop."}, Range::Positive(), stop_s);
  v.Number({"rest_s", "Time at rest before and after."}, Range::NonNegative(), rest_s);
  v.Number({"turn_time_s", "Time over which the heading is averaged."}, Range::Positive(), turn_time_s);
  v.Number({"height_m", "Height of the device above the axis of the pipe."}, Range::Any(), height_m);
  v.Number({"wobble_m", "Amplitude of the hand's up and down."}, Range::NonNegative(), wobble_m);
  v.Number({"wobble_rad", "Amplitude of the hand's pitch and roll."}, Range::NonNegative(), wobble_rad);
  v.Number({"wobble_Hz", "Steps per second."}, Range::Positive(), wobble_Hz);
}

WalkScript::WalkScript(const WalkParams& params, const Route& route)
    : height_m_(params.height_m), track_(WalkRows(params, route).MakeScript()) {}

}  // namespace piperun::sim
