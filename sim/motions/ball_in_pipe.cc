// The ball carried by the water, in the Bullet world.

#include <cmath>

#include "base/check.h"
#include "base/number.h"
#include "base/random.h"
#include "sim/ball_world.h"
#include "sim/fluid_load.h"
#include "sim/motion.h"

namespace piperun::sim {
namespace {

constexpr double kMaxDiameterRatio = 0.95;  // as far as wall factor and profile table go
constexpr double kProgress_m = 0.01;
constexpr double kTouching_m = 1e-6;  // far above rounding, far below anything a ball would feel

struct BallInPipeParams : ParamsOf<BallInPipeParams> {
  double rate_Hz = 1000;

  void Visit(ParamVisitor& v) override {
    v.Number({"rate_Hz", "Steps of the physics per second."}, Range::Between(100, 10000), rate_Hz);
  }
};

void RequireFit(const BallParams& ball, const Route& route) {
  const double bore_radius_m = route.pieces().front().radius_m;
  if (ball.radius_m > kMaxDiameterRatio * bore_radius_m) {
    throw InputError("the ball's radius is " + FormatNumber(ball.radius_m) + " m; in a bore of " +
                         FormatNumber(2 * bore_radius_m) + " m it must lie in (0, " +
                         FormatNumber(kMaxDiameterRatio * bore_radius_m) + "] m",
                     "ball.radius_m");
  }
}

/// Across the pipe, the way gravity pulls; in a vertical pipe any direction across.
Vector3d FindDown(const Vector3d& gravity_W, const Vector3d& tangent_W) {
  const Vector3d across = gravity_W - gravity_W.dot(tangent_W) * tangent_W;
  if (across.norm() > 1e-9 * gravity_W.norm()) return across.normalized();
  return tangent_W.unitOrthogonal();
}

/// At rest on the invert at chainage 0, moved around the wall by an arc a ~ N(0, lateral_sd): the angle is
/// a/R. B: x along the pipe, z against gravity across the pipe, y = z x x to the left.
BallStart MakeStart(const MotionContext& context, double lateral_sd_m) {
  const RoutePiece& piece = context.route->pieces().front();
  const CentrelinePoint axis = EvalCentreline(piece.line, 0);
  const Vector3d x = axis.tangent_W, z = -FindDown(context.gravity_W, x), y = z.cross(x);
  const double draw = RandomStream(context.seed, "launch", context.run).Normals(0, 0)[0];
  const double angle = lateral_sd_m * draw / piece.radius_m;
  Matrix3d R_WB;
  R_WB << x, y, z;
  const Vector3d towards_wall = std::sin(angle) * y - std::cos(angle) * z;
  BallStart start;
  start.X_WB = {axis.p_W + (piece.radius_m - context.ball.radius_m) * towards_wall,
                Quaterniond(R_WB).normalized()};
  return start;
}

TubeBall MakeTubeBall(const BallParams& ball, const FluidLoadCoefficients& c) {
  const double r = ball.radius_m;
  return {r, ball.mass_kg() + c.added_mass_kg, ball.inertia_factor * ball.mass_kg() * r * r, ball.friction,
          ball.rolling_resistance * r};
}

/// The pipes of the route; whatever else meets them at its nodes is closed to the ball.
std::vector<bool> FindOpenPipes(const Network& network, const Route& route) {
  std::vector<bool> open(network.pipes().size());
  for (const RouteLeg& leg : route.legs()) open[static_cast<std::size_t>(leg.pipe)] = true;
  return open;
}

class BallInPipe : public Motion {
 public:
  BallInPipe(const BallInPipeParams& params, const MotionContext& context)
      : context_(context),
        rate_(params.rate_Hz),
        bore_(*context.network, FindOpenPipes(*context.network, *context.route)),
        field_(bore_, *context.flow, context.water, context.gravity_W.norm(), context.ball.radius_m),
        coefficients_(CalcFluidLoadCoefficients(context.ball, context.water, context.gravity_W)),
        world_(*context.route, MakeTubeBall(context.ball, coefficients_), rate_,
               MakeStart(context, context.lateral_sd_m),
               [this](const BallInstant& ball) { return EvalLoad(ball); }) {
    Publish();
    progress_m_ = state_.chainage_m;
  }

  Rate rate() const override { return rate_; }
  const TruthState& state() const override { return state_; }
  MotionStatus status() const override { return status_; }
  Vector3d planned_start_W() const override { return MakeStart(context_, 0).X_WB.p; }

  void Step() override {
    world_.Step();
    Publish();
    UpdateStatus();
  }

 private:
  BallLoad EvalLoad(const BallInstant& ball) {
    const RoutePiece& piece = context_.route->pieces()[ball.spot.piece];
    const int sense = piece.reversed ? -1 : 1;
    NetworkSpot spot{piece.pipe, 0, piece.PipeS_m(ball.spot.chainage_m), ball.spot.axis};
    spot.axis.tangent_W *= sense;
    water_ = field_.Eval(spot, ball.p_WB, ball.time);
    water_.bulk_speed_m_s *= sense;
    const FluidLoad load = CalcFluidLoad(coefficients_, ball.v_WB_W, ball.w_WB_W, water_);
    return {load.Force_W_N(), load.spin_torque_W_N_m};
  }

  void Publish() {
    const BallState& ball = world_.state();
    const Quaterniond q_BW = ball.X_WB.q.conjugate();
    state_.time = ball.time;
    state_.X_WB = ball.X_WB;
    state_.v_WB_W = ball.v_WB_W;
    state_.w_WB_B = q_BW * ball.w_WB_W;
    state_.f_WB_B = q_BW * (ball.a_WB_W - context_.gravity_W);
    state_.v_step_W = ball.v_step_W;
    state_.dtheta_B_rad = ball.dtheta_B_rad;
    const RoutePiece& piece = context_.route->pieces()[ball.spot.piece];
    state_.pipe = piece.pipe;
    state_.s_m = piece.PipeS_m(ball.spot.chainage_m);
    state_.chainage_m = ball.spot.chainage_m;
    state_.water_speed_m_s = water_.bulk_speed_m_s;
    state_.pressure_Pa = water_.pressure_Pa;
    const double offset_m = (ball.X_WB.p - ball.spot.axis.p_W).norm();
    state_.contact = piece.radius_m - context_.ball.radius_m - offset_m < kTouching_m;
  }

  void UpdateStatus() {
    if (status_ != MotionStatus::kRunning) return;
    const RouteSpot& spot = world_.state().spot;
    if (state_.chainage_m >= progress_m_ + kProgress_m) {
      progress_m_ = state_.chainage_m;
      progress_time_ = state_.time;
    }
    const double offset_m = (state_.X_WB.p - spot.axis.p_W).norm();
    if (!(state_.X_WB.p.allFinite() && state_.f_WB_B.allFinite() && state_.w_WB_B.allFinite())) {
      status_ = MotionStatus::kNotFinite;
    } else if (offset_m > context_.route->pieces()[spot.piece].radius_m ||
               state_.chainage_m < -context_.ball.radius_m) {
      status_ = MotionStatus::kLeftNetwork;
    } else if (state_.chainage_m >= context_.route->length_m()) {
      status_ = MotionStatus::kArrived;
    } else if (Seconds(state_.time - progress_time_) >= context_.stuck_after_s) {
      status_ = MotionStatus::kBallStuck;
    }
  }

  MotionContext context_;
  Rate rate_;
  Bore bore_;
  FlowField field_;
  FluidLoadCoefficients coefficients_;
  WaterAtBall water_;  // where and when the world evaluated the loads last: at its present state
  BallWorld world_;
  TruthState state_;
  MotionStatus status_ = MotionStatus::kRunning;
  double progress_m_ = 0;  // farthest chainage that counted as progress, and when it was reached
  TrueTime progress_time_{};
};

std::unique_ptr<Motion> Make(const Params& params, const MotionContext& context) {
  if (!context.route) throw InputError("a ball in a pipe needs a network with at least one pipe", "kind");
  Demand(context.flow != nullptr, "whoever builds a route solves its flow");
  RequireFit(context.ball, *context.route);
  return std::make_unique<BallInPipe>(static_cast<const BallInPipeParams&>(params), context);
}

}  // namespace

namespace motions::ball_in_pipe {
MotionKind Kind() {
  return {"ball_in_pipe", "A ball carried through the route by the water, in a Bullet scene.",
          MakeParams<BallInPipeParams>, Make};
}
}  // namespace motions::ball_in_pipe

}  // namespace piperun::sim
