// The ball carried by the water through a network, in the Bullet world.

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "sim/ball_mass.h"
#include "sim/ball_world.h"
#include "sim/contact_events.h"
#include "sim/downstream.h"
#include "sim/fluid_load.h"
#include "sim/force_params.h"
#include "sim/launch.h"
#include "sim/load_ranges.h"
#include "sim/motion.h"
#include "sim/step_resolution.h"
#include "sim/stream_fluctuations.h"

namespace piperun::sim {
namespace {

constexpr double kProgress_m = 0.01;

struct BallInPipeParams : ParamsOf<BallInPipeParams> {
  double rate_Hz = 1000;
  double contact_event_speed_m_s = 0.01;
  ForceParams forces;
  StreamParams stream;

  void Visit(ParamVisitor& v) override {
    v.Number({"rate_Hz", "Steps of the physics per second."}, Range::Between(100, kMaxStepRate_Hz), rate_Hz);
    v.Number({"contact_event_speed_m_s",
              "Closing speed above which a contact is a collision; what carries the ball comes on top."},
             Range::Between(1e-4, 10), contact_event_speed_m_s);
    v.Struct({"forces", "Which laws act on the ball."}, forces);
    v.Struct({"stream", "The flow in a pipe beyond its bulk speed."}, stream);
  }
};

/// Refuses a contact that is too short for the steps.
StepResolution WatchSteps(const BallParams& ball, const FluidLoadCoefficients& c, Rate rate) {
  if (!ball.contact_stiffness_N_m) return {rate, 0};
  RequireResolvedContact(*ball.contact_stiffness_N_m, c.inertial_mass_kg, rate);
  return {rate, CalcContactPhase_rad(*ball.contact_stiffness_N_m, c.inertial_mass_kg, rate)};
}

/// Share of a sudden change of the water's velocity that the ball takes part in without drag (chi,
/// sim/turbulence.h).
double CalcResponse(const FluidLoadCoefficients& c) {
  return std::min(1.0, c.accelerated_mass_kg / c.inertial_mass_kg);
}

/// Of the pipes that are open to the ball; first the one it is put into.
std::vector<double> BoreRadii_m(const MotionContext& context) {
  std::vector<double> radii_m{context.network->pipe(context.launch.pipe).radius_m()};
  for (int i = 0; i < static_cast<int>(context.network->pipes().size()); ++i) {
    if (context.bore->open(i)) radii_m.push_back(context.network->pipe(i).radius_m());
  }
  return radii_m;
}

TubeBall MakeTubeBall(const BallParams& ball, const FluidLoadCoefficients& c) {
  const double r = ball.radius_m;
  const BallMass mass = CalcBallMass(ball, c.added_mass_kg);
  TubeBall tube_ball;
  tube_ball.radius_m = r;
  tube_ball.mass_kg = mass.mass_kg;
  tube_ball.inertia_B_kg_m2 = mass.inertia_B_kg_m2;
  tube_ball.friction = ball.friction;
  tube_ball.rolling_length_m = ball.rolling_resistance * r;
  tube_ball.spinning_length_m = ball.spinning_resistance * r;
  tube_ball.restitution = ball.restitution;
  tube_ball.p_BM_B = mass.p_BM_B;
  if (ball.contact_stiffness_N_m) {
    tube_ball.compliance = {*ball.contact_stiffness_N_m, ball.contact_damping_N_s_m};
  }
  return tube_ball;
}

class BallInPipe : public Motion {
 public:
  BallInPipe(const BallInPipeParams& params, const MotionContext& context)
      : context_(context),
        rate_(params.rate_Hz),
        way_(*context.network, context.launch),
        field_(*context.bore, *context.flow, context.water, context.gravity_W.norm(), context.ball.radius_m,
               params.stream),
        coefficients_(CalcFluidLoadCoefficients(context.ball, params.forces, context.water, context.gravity_W,
                                                BoreRadii_m(context))),
        ranges_(coefficients_, context.water, FindProfileLaw(params.stream.profile)),
        fluctuations_(params.stream, context.seed, context.run, rate_, 2 * context.ball.radius_m,
                      CalcResponse(coefficients_), context.water.kinematic_viscosity_m2_s),
        steps_(WatchSteps(context.ball, coefficients_, rate_)),
        world_(*context.bore, MakeTubeBall(ApplyForces(context.ball, params.forces), coefficients_), rate_,
               MakeLaunch(context, context.lateral_sd_m),
               [this](const BallInstant& ball) { return load_ = EvalLoad(ball); }),
        contact_events_(context.ball.radius_m, coefficients_.inertial_mass_kg,
                        params.contact_event_speed_m_s) {
    Publish();
    progress_m_ = state_.chainage_m;
  }

  Rate rate() const override { return rate_; }
  const TruthState& state() const override { return state_; }
  MotionStatus status() const override { return status_; }
  Vector3d planned_start_W() const override { return MakeLaunch(context_, 0).X_LB.p; }
  const Way* way() const override { return &way_; }
  std::span<const ContactEvent> contact_events() const override { return contact_events_.ended(); }

  std::vector<std::string> warnings() const override {
    std::vector<std::string> warnings = steps_.Warnings();
    const std::vector<std::string> excursions = ranges_.Sentences();
    warnings.insert(warnings.end(), excursions.begin(), excursions.end());
    if (const auto rescues = world_.state().rescues; rescues > 0) {
      warnings.push_back("the ball had to be pushed back into the bores in " + std::to_string(rescues) +
                         " steps; pipes there overlap in a way that joints do not");
    }
    return warnings;
  }

  void Step() override {
    fluctuations_.Step();
    world_.Step();
    if (world_.state().crossing) way_.Cross(*world_.state().crossing);
    Publish();
    DetectContactEvents();
    const BallState& ball = world_.state();
    steps_.AddMotion(ball.w_WB_W.norm(), ball.v_WB_W.norm(), ball.spot.axis.curvature_W.norm());
    UpdateStatus();
  }

 private:
  BallLoad EvalLoad(const BallInstant& ball) {
    if (!Fits(context_.ball, PipeOf(ball.spot).RadiusAt_m(ball.spot.s_m))) too_large_ = true;
    if (too_large_) return {};  // beyond what drag is known for; the run is over
    water_ = field_.Eval(ball.spot, ball.p_LB, ball.time, fluctuations_.swirl());
    fluctuations_.AddTo(ball.spot, ball.p_LB, water_);
    FluidLoad load = CalcFluidLoad(coefficients_, ball.v_WB_W, ball.w_WB_W, water_);
    ranges_.Feed(load.numbers, water_);
    load.drag_W_N *=
        steps_.HoldDrag(2 * load.drag_over_slip_N_s_m * rate_.Period_s() / coefficients_.inertial_mass_kg);
    return {load.Force_W_N(), load.spin_torque_W_N_m + CalcWeightTorque_W_N_m(ball.q_WB)};
  }

  /// Of the weight, about the sphere's centre, where the loads act: r_C x m g.
  Vector3d CalcWeightTorque_W_N_m(const Quaterniond& q_WB) const {
    if (context_.ball.center_of_mass_B_m.isZero(0)) return Vector3d::Zero();
    const Vector3d p_BC_W = q_WB * context_.ball.center_of_mass_B_m;
    return p_BC_W.cross(context_.ball.mass_kg() * context_.gravity_W);
  }

  void DetectContactEvents() {
    const BallState& ball = world_.state();
    const double carried_N = contact_events_.IsIdle(ball.contacts)
                                 ? 0
                                 : CalcCarriedForce_N(load_.force_W_N.norm(), coefficients_.inertial_mass_kg,
                                                      ball.spot.axis, ball.X_LB.p, ball.v_WB_W);
    contact_events_.Step(
        {ball.time, rate_.Period_s(), carried_N, {state_.X_WB.p, state_.pipe, state_.s_m, state_.chainage_m}},
        ball.contacts);
  }

  const Pipe& PipeOf(const NetworkSpot& spot) const { return context_.network->pipe(spot.pipe); }

  void Publish() {
    const BallState& ball = world_.state();
    const Quaterniond q_BW = ball.X_LB.q.conjugate();
    const WayLeg& leg = way_.leg();
    state_.time = ball.time;
    state_.X_WB = {ball.X_LB.p + leg.offset_W, ball.X_LB.q};
    state_.v_WB_W = ball.v_WB_W;
    state_.w_WB_B = q_BW * ball.w_WB_W;
    state_.f_WB_B = q_BW * (ball.a_WB_W - context_.gravity_W);
    state_.v_step_W = ball.v_step_W;
    state_.dtheta_B_rad = ball.dtheta_B_rad;
    state_.pipe = ball.spot.pipe;
    state_.s_m = ball.spot.s_m;
    state_.reversed = leg.reversed;
    state_.chainage_m = way_.Chainage_m(ball.spot.s_m);
    state_.water_speed_m_s = leg.reversed ? -water_.bulk_speed_m_s : water_.bulk_speed_m_s;
    state_.pressure_Pa = water_.pressure_Pa;
    state_.v_slip_W = water_.velocity_W - ball.v_WB_W;
    offset_m_ = (ball.X_LB.p - ball.spot.axis.p_W).norm();
    state_.contact =
        ball.normal_force_N > 0 ||
        PipeOf(ball.spot).RadiusAt_m(ball.spot.s_m) - context_.ball.radius_m - offset_m_ < kTouching_m;
  }

  void UpdateStatus() {
    if (status_ != MotionStatus::kRunning) return;
    if (state_.chainage_m >= progress_m_ + kProgress_m) {
      progress_m_ = state_.chainage_m;
      progress_time_ = state_.time;
    }
    status_ = FindStatus();
  }

  MotionStatus FindStatus() const {
    if (!(state_.X_WB.p.allFinite() && state_.f_WB_B.allFinite() && state_.w_WB_B.allFinite())) {
      return MotionStatus::kNotFinite;
    }
    const BallState& ball = world_.state();
    if (!context_.bore->Contains(ball.spot.pipe, ball.spot.s_m, offset_m_, ball.X_LB.p)) {
      return MotionStatus::kLeftNetwork;
    }
    if (const int node = NodePassed(); node >= 0) {
      if (node == context_.retrieve_node) return MotionStatus::kArrived;
      if (context_.network->nodes()[static_cast<std::size_t>(node)].open_water)
        return MotionStatus::kLeftNetwork;
    }
    if (too_large_) return MotionStatus::kTooLarge;
    if (Seconds(state_.time - progress_time_) >= context_.stuck_after_s) return FindWhyStuck();
    return MotionStatus::kRunning;
  }

  /// The node at whose far side the ball has come with this step, or beyond which it is at a dead end; -1:
  /// none.
  int NodePassed() const {
    const BallState& ball = world_.state();
    if (ball.crossing) return context_.network->NodeAt(ball.crossing->left);
    const Pipe& pipe = PipeOf(ball.spot);
    if (ball.spot.s_m >= pipe.length_m) return pipe.to;
    return ball.spot.s_m < 0 ? pipe.from : -1;
  }

  MotionStatus FindWhyStuck() const {
    const NetworkSpot& spot = world_.state().spot;
    const Downstream downstream(*context_.bore, *context_.flow, state_.time);
    if (const Joint* joint = context_.bore->FindJoint(spot.pipe, spot.s_m)) {
      if (downstream.LeadsIntoNarrower(*joint, context_.ball.radius_m / kMaxDiameterRatio))
        return MotionStatus::kTooLarge;
      if (joint->dead_end() && !downstream.LeadsAway(*joint)) return MotionStatus::kDeadEnd;
      if (joint->arms.size() > 2) return MotionStatus::kStalledAtTee;
    }
    return downstream.LeadsOn(spot.pipe, context_.retrieve_node) ? MotionStatus::kBallStuck
                                                                 : MotionStatus::kDeadEnd;
  }

  MotionContext context_;
  Rate rate_;
  Way way_;
  FlowField field_;
  FluidLoadCoefficients coefficients_;
  LoadRanges ranges_;
  StreamFluctuations fluctuations_;
  WaterAtBall water_;  // where and when the world evaluated the loads last: at its present state
  bool too_large_ = false;
  BallLoad load_;  // what the world was given last
  StepResolution steps_;
  BallWorld world_;
  ContactEventDetector contact_events_;
  TruthState state_;
  double offset_m_ = 0;  // of the ball's centre from the axis, at state_
  MotionStatus status_ = MotionStatus::kRunning;
  double progress_m_ = 0;  // farthest chainage that counted as progress, and when it was reached
  TrueTime progress_time_{};
};

std::unique_ptr<Motion> Make(const Params& params, const MotionContext& context) {
  if (!context.bore) throw InputError("a ball in a pipe needs a network with at least one pipe", "kind");
  Demand(context.flow != nullptr, "whoever builds a network solves its flow");
  context.ball.Check();
  RequireFit(context);
  return std::make_unique<BallInPipe>(static_cast<const BallInPipeParams&>(params), context);
}

}  // namespace

namespace motions::ball_in_pipe {
MotionKind Kind() {
  return {"ball_in_pipe", "A ball carried through the network by the water, in a Bullet scene.",
          MakeParams<BallInPipeParams>, Make};
}
}  // namespace motions::ball_in_pipe

}  // namespace piperun::sim
