#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "base/check.h"
#include "base/pose.h"
#include "base/time.h"

namespace piperun::sim {

/// What really happened, at the end of one physics step. Frame B has its origin at the ball's geometric
/// centre. The world is integrated leapfrog: positions at whole steps, velocities half a step earlier, so a
/// state carries both the velocity of its step (exact for mechanisation) and the velocity at its instant.
struct TruthState {
  TrueTime time{};
  Pose X_WB;
  Vector3d v_WB_W = Vector3d::Zero();  ///< at `time`: mean of the steps before and after
  Vector3d w_WB_B = Vector3d::Zero();  ///< at `time`
  Vector3d f_WB_B = Vector3d::Zero();  ///< specific force of the centre at `time`: (v_step' - v_step)/dt - g

  /// The step that ended at `time`: p = p_before + v_step dt and R = R_before Exp(dtheta), to rounding.
  /// In the start state v_step is the start velocity and dtheta is zero.
  Vector3d v_step_W = Vector3d::Zero();
  Vector3d dtheta_B_rad = Vector3d::Zero();

  int pipe = -1;  ///< -1: not in a pipe
  double s_m = 0;
  bool reversed = false;       ///< chainage rises where s falls: the ball came in at the pipe's `to` end
  double chainage_m = 0;       ///< along the way taken
  double water_speed_m_s = 0;  ///< bulk velocity Q/A where the ball is, positive the way chainage rises
  double pressure_Pa = 0;      ///< gauge, static, at the ball's centre
  /// Velocity of the water less that of the ball's centre: the water as it would flow there without the ball.
  /// Zero where no water is known.
  Vector3d v_slip_W = Vector3d::Zero();
  bool contact = false;  ///< touching the wall
};

/// The last few truth states, by step number, for sensors to sample from. Step k is at SampleTime(k, rate).
class TruthWindow {
 public:
  /// Holds at least `capacity` steps.
  TruthWindow(Rate rate, std::size_t capacity);

  void Push(const TruthState& state);  ///< steps arrive in order, beginning with step 0
  Rate rate() const { return rate_; }
  /// Oldest step still held.
  std::int64_t first() const {
    return std::max<std::int64_t>(0, next_ - static_cast<std::int64_t>(ring_.size()));
  }
  std::int64_t last() const { return next_ - 1; }
  /// Aborts when `step` is not in [first, last]: the window was made too small.
  const TruthState& at(std::int64_t step) const {
    Demand(step >= first() && step <= last(), "this step is not in the truth window");
    return ring_[static_cast<std::size_t>(step) & mask_];
  }
  TrueTime latest_time() const { return SampleTime(last(), rate_); }
  /// Last step at or before t.
  std::int64_t StepAt(TrueTime t) const;

 private:
  Rate rate_;
  std::vector<TruthState> ring_;  // a power of two of them
  std::size_t mask_;
  std::int64_t next_ = 0;
};

/// State at any instant in the window: position along the cubic through both ends' velocities, attitude along
/// the geodesic, scalars linear. Exact at whole steps.
TruthState Interpolate(const TruthWindow& window, TrueTime t);

}  // namespace piperun::sim
