#include "sim/ball_world.h"

#include <utility>

#include "sim/bullet/bullet_world.h"

namespace piperun::sim {

class BallWorld::Impl {
 public:
  Impl(const Route& route, const TubeBall& ball, Rate rate, const BallStart& start, BallLoadFunction load)
      : route_(route),
        ball_(ball),
        rate_(rate),
        dt_s_(rate.Period_s()),
        load_(std::move(load)),
        world_(route, {ball.radius_m, ball.mass_kg, ball.inertia_kg_m2, ball.friction, ball.rolling_length_m},
               start.X_WB.p, start.v_WB_W, start.w_WB_W) {
    state_.X_WB = start.X_WB;
    state_.v_step_W = start.v_WB_W;
    state_.dtheta_B_rad.setZero();
    state_.spot = FindRouteSpot(route_, start.X_WB.p, 0);
    w_step_W_ = start.w_WB_W;
    StepAhead(start.v_WB_W, start.w_WB_W, 0.5 * dt_s_);
    // the half kick leads to t = dt/2: the start velocity is the one at the instant
    state_.v_WB_W = start.v_WB_W;
    state_.w_WB_W = start.w_WB_W;
  }

  const BallState& state() const { return state_; }

  void Step() {
    const Vector3d v_ahead = world_.v_W();
    const Vector3d w_ahead = world_.w_W();
    const Vector3d v_now = v_ahead + 0.5 * dt_s_ * state_.a_WB_W;
    const Vector3d w_now = w_ahead + 0.5 * dt_s_ * state_.alpha_WB_W;
    state_.time = SampleTime(++step_, rate_);
    state_.X_WB.p = world_.p_W();
    state_.v_step_W = v_ahead;
    state_.dtheta_B_rad = state_.X_WB.q.conjugate() * w_ahead * dt_s_;
    state_.X_WB.q = (state_.X_WB.q * ExpSO3(state_.dtheta_B_rad)).normalized();
    state_.spot = FindRouteSpot(route_, state_.X_WB.p, state_.spot.piece);
    w_step_W_ = w_ahead;
    StepAhead(v_now, w_now, dt_s_);
    state_.v_WB_W = 0.5 * (v_ahead + world_.v_W());
    state_.w_WB_W = 0.5 * (w_ahead + world_.w_W());
  }

 private:
  /// Kicks the ball with the loads at the present instant and lets it drift one step; fills what the state
  /// learns from that.
  void StepAhead(const Vector3d& v_now_W, const Vector3d& w_now_W, double kick_s) {
    const BallLoad load = load_({state_.time, state_.X_WB.p, v_now_W, w_now_W, state_.spot});
    world_.Step(state_.spot, kick_s / ball_.mass_kg * load.force_W_N,
                kick_s / ball_.inertia_kg_m2 * load.torque_W_N_m, dt_s_);
    state_.a_WB_W = (world_.v_W() - state_.v_step_W) / kick_s;
    state_.alpha_WB_W = (world_.w_W() - w_step_W_) / kick_s;
    state_.normal_force_N = world_.normal_impulse_N_s() / kick_s;
  }

  const Route& route_;
  TubeBall ball_;
  Rate rate_;
  double dt_s_;
  BallLoadFunction load_;
  bullet::BulletWorld world_;  // one step ahead of state_
  BallState state_;
  Vector3d w_step_W_;  // angular velocity of the step that ended at state_.time
  std::int64_t step_ = 0;
};

BallWorld::BallWorld(const Route& route, const TubeBall& ball, Rate rate, const BallStart& start,
                     BallLoadFunction load)
    : impl_(std::make_unique<Impl>(route, ball, rate, start, std::move(load))) {}
BallWorld::~BallWorld() = default;

const BallState& BallWorld::state() const { return impl_->state(); }
void BallWorld::Step() { impl_->Step(); }

}  // namespace piperun::sim
