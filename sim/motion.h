#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/network.h"
#include "base/params.h"
#include "base/route.h"
#include "base/water.h"
#include "sim/ball.h"
#include "sim/bore.h"
#include "sim/flow_timeline.h"
#include "sim/truth.h"
#include "sim/way.h"

namespace piperun::sim {

enum class MotionStatus {
  kRunning,
  kArrived,
  kBallStuck,
  kStalledAtTee,  ///< no progress where several pipes meet
  kDeadEnd,       ///< no progress where no water leads on
  kTooLarge,      ///< came to a pipe it does not fit into
  kLeftNetwork,   ///< into a reservoir or tank, or through the wall
  kNotFinite,
};

/// A collision of the ball with the wall or something on it, from its beginning until the two no longer press
/// on each other beyond what carries the ball.
struct ContactEvent {
  TrueTime begin{};
  double duration_s = 0;
  int pipe = -1;
  double s_m = 0;                             ///< along the pipe
  double chainage_m = 0;                      ///< along the way
  Vector3d p_W = Vector3d::Zero();            ///< where ball and wall touched, at the beginning
  Vector3d impulse_W_N_s = Vector3d::Zero();  ///< of the wall on the ball
  double closing_speed_m_s = 0;
  double peak_force_N = 0;
  int feature = -1;  ///< index of the wall feature; -1: the wall
};

/// A collision comes to its end, and is told, at most this long after it began.
inline constexpr Duration kContactEventDelay = std::chrono::milliseconds(100);

/// Everything a motion may need; it keeps references, the caller keeps the objects alive.
struct MotionContext {
  std::uint64_t seed = 0;
  std::uint64_t run = 0;
  Vector3d gravity_W{0, 0, -9.80665};
  WaterProperties water;
  const Network* network = nullptr;  ///< null: the scenario has no pipes
  const Route* route = nullptr;      ///< the planned way
  const Bore* bore = nullptr;        ///< the pipes that are open to the ball
  const FlowTimeline* flow = nullptr;
  PipeEnd launch;          ///< the pipe the ball is put into, and at which of its ends
  int retrieve_node = -1;  ///< -1: wherever the water takes it
  BallParams ball;
  double lateral_sd_m = 0;    ///< scatter of the launch position across the pipe
  double stuck_after_s = 30;  ///< no progress for this long means stuck
};

/// A source of truth: the Bullet world, or a script. Deterministic in its context.
class Motion {
 public:
  virtual ~Motion() = default;
  virtual Rate rate() const = 0;
  /// The start state, complete, before the first Step(); then the state after each step, complete (a motion
  /// computes one step ahead where the velocity at an instant needs it).
  virtual const TruthState& state() const = 0;
  virtual void Step() = 0;
  /// Anything but kRunning is final; the state that made it so is still delivered.
  virtual MotionStatus status() const = 0;
  /// Where the crew means to put the ball: the start without its scatter. Asked before the first Step().
  virtual Vector3d planned_start_W() const { return state().X_WB.p; }
  /// The way taken so far; null for motions that know no pipes.
  virtual const Way* way() const { return nullptr; }
  /// What a user should know of how the motion was computed, a sentence each; empty when all went as it
  /// should.
  virtual std::vector<std::string> warnings() const { return {}; }
  /// Collisions that came to their end with the last Step(); those that a run leaves unfinished are not told.
  virtual std::span<const ContactEvent> contact_events() const { return {}; }
};

struct MotionKind {
  std::string_view name;
  std::string_view doc;
  std::unique_ptr<Params> (*make_params)();
  /// Throws InputError for parameters that contradict each other or the context.
  std::unique_ptr<Motion> (*make)(const Params& params, const MotionContext& context);
};

/// Generated from sim/motions/*.cc.
const std::vector<MotionKind>& MotionKinds();

}  // namespace piperun::sim
