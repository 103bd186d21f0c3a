#include "sim/ball_world.h"

#include <utility>

#include "sim/bullet/bullet_world.h"

namespace piperun::sim {

class BallWorld::Impl {
 public:
  Impl(const Bore& bore, const TubeBall& ball, Rate rate, const BallStart& start, BallLoadFunction load)
      : bore_(bore), rate_(rate), dt_s_(rate.Period_s()), load_(std::move(load)), world_(bore, ball, start) {
    state_.X_LB = start.X_LB;
    state_.v_step_W = start.v_WB_W;
    state_.dtheta_B_rad.setZero();
    state_.spot = start.spot;
    w_step_W_ = start.w_WB_W;
    StepAhead(start.v_WB_W, start.w_WB_W, 0.5 * dt_s_);
    // the half kick leads to t = dt/2: the start velocity is the one at the instant
    state_.v_WB_W = start.v_WB_W;
    state_.w_WB_W = start.w_WB_W;
  }

  const BallState& state() const { return state_; }

  void Step() {
    const Vector3d v_ahead = world_.v_step_L();
    const Vector3d w_ahead = world_.w_L();
    const Vector3d v_now = v_ahead + 0.5 * dt_s_ * state_.a_WB_W;
    const Vector3d w_now = w_ahead + 0.5 * dt_s_ * state_.alpha_WB_W;
    state_.time = SampleTime(++step_, rate_);
    Relocate();
    state_.v_step_W = v_ahead;
    state_.dtheta_B_rad = world_.dtheta_B_rad();
    state_.X_LB.q = world_.q_LB();
    w_step_W_ = w_ahead;
    StepAhead(v_now, w_now, dt_s_);
    state_.v_WB_W = 0.5 * (v_ahead + world_.v_step_L());
    state_.w_WB_W = 0.5 * (w_ahead + world_.w_L());
  }

 private:
  void Relocate() {
    const Vector3d& p_L = world_.p_L();
    const SpotMove move = FindNetworkSpot(bore_, p_L, state_.spot);
    state_.X_LB.p = move.crossing ? Vector3d(p_L + move.crossing->shift_L) : p_L;
    world_.MoveTo(move);
    state_.spot = move.spot;
    state_.crossing = move.crossing;
  }

  /// Kicks the ball with the loads at the present instant and lets it drift one step; fills what the state
  /// learns from that.
  void StepAhead(const Vector3d& v_now_W, const Vector3d& w_now_W, double kick_s) {
    const BallLoad load = load_({state_.time, state_.X_LB.p, state_.X_LB.q, v_now_W, w_now_W, state_.spot});
    world_.Step(load, kick_s, dt_s_);
    state_.a_WB_W = (world_.v_step_L() - state_.v_step_W) / kick_s;
    state_.alpha_WB_W = (world_.w_L() - w_step_W_) / kick_s;
    state_.normal_force_N = world_.normal_impulse_N_s() / kick_s;
    state_.contacts = world_.contacts();
    state_.rescues = world_.rescues();
  }

  const Bore& bore_;
  Rate rate_;
  double dt_s_;
  BallLoadFunction load_;
  bullet::BulletWorld world_;  // one step ahead of state_
  BallState state_;
  Vector3d w_step_W_;  // angular velocity of the step that ended at state_.time
  std::int64_t step_ = 0;
};

BallWorld::BallWorld(const Bore& bore, const TubeBall& ball, Rate rate, const BallStart& start,
                     BallLoadFunction load)
    : impl_(std::make_unique<Impl>(bore, ball, rate, start, std::move(load))) {}
BallWorld::~BallWorld() = default;

const BallState& BallWorld::state() const { return impl_->state(); }
void BallWorld::Step() { impl_->Step(); }

}  // namespace piperun::sim
