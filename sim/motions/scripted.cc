#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "base/check.h"
#include "sim/motion.h"
#include "sim/rolling_script.h"
#include "sim/route_spot.h"
#include "sim/script.h"
#include "sim/walk_script.h"
#include "sim/waypoint_script.h"

namespace piperun::sim::motions::scripted {
namespace {

struct RestParams {
  double duration_s = 10;
  Vector3d position_m = Vector3d::Zero();
  Vector3d yaw_pitch_roll_rad = Vector3d::Zero();

  void Visit(ParamVisitor& v) {
    v.Number({"duration_s", "Length of the record."}, Range::Positive(), duration_s);
    v.Vector({"position_m", "Where the body lies, in W."}, Range::Any(), position_m);
    v.Vector({"yaw_pitch_roll_rad", "How it lies: R_WB = Rz(yaw) Ry(pitch) Rx(roll)."}, Range::Any(),
             yaw_pitch_roll_rad);
  }
};

constexpr std::array<std::string_view, 4> kScripts{"rest", "rolling", "walk", "waypoints"};

struct ScriptedParams : ParamsOf<ScriptedParams> {
  double rate_Hz = 1000;
  std::string script{kScripts[0]};
  RestParams rest;
  RollingParams rolling;
  WalkParams walk;
  WaypointParams waypoints;

  void Visit(ParamVisitor& v) override {
    v.Number({"rate_Hz", "Rate of the truth."}, Range::Between(100, 10000), rate_Hz);
    v.Choice({"script", "Which of the scripts below is played."}, kScripts, script);
    v.Struct({"rest", "Nothing moves."}, rest);
    v.Struct({"rolling", "The ball rolls without slip on a plane round a polygon with rounded corners."},
             rolling);
    v.Struct({"walk", "Somebody carries the device along the route."}, walk);
    v.Struct({"waypoints", "Timed poses joined by C2 splines, with stops."}, waypoints);
  }
};

std::unique_ptr<Script> MakeRest(const RestParams& p) {
  return std::make_unique<WaypointScript>(std::vector<double>{0, p.duration_s},
                                          std::vector<Vector3d>(2, p.position_m),
                                          std::vector<Vector3d>(2, p.yaw_pitch_roll_rad));
}

std::unique_ptr<Script> MakeScript(const ScriptedParams& p, const MotionContext& context) {
  if (p.script == "rest") return MakeRest(p.rest);
  if (p.script == "rolling") return std::make_unique<RollingScript>(p.rolling, context.ball.radius_m);
  if (p.script == "waypoints") return std::make_unique<WaypointScript>(p.waypoints);
  Demand(p.script == "walk", "a script is one of kScripts");
  if (!context.route) {
    throw InputError("a walk follows the route through the network; give `network` and `mission`", "script");
  }
  return std::make_unique<WalkScript>(p.walk, *context.route);
}

/// Piece of the route nearest to a point; of several equally near (to 1 um) the first: a loop begins where it
/// ends.
std::size_t FindNearestPiece(const Route& route, const Vector3d& p_W) {
  constexpr double kEquallyNear_m = 1e-6;
  std::size_t nearest = 0;
  double nearest_m = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < route.pieces().size(); ++i) {
    const CentrelinePiece& line = route.pieces()[i].line;
    const double s = std::clamp(FindNearest(line, p_W), line.s_begin_m, line.s_end_m());
    const double distance_m = (EvalCentreline(line, s).p_W - p_W).norm();
    if (distance_m < nearest_m - kEquallyNear_m) {
      nearest_m = distance_m;
      nearest = i;
    }
  }
  return nearest;
}

/// Truth from a script: everything at an instant is exact, the velocity of a step is the mean over it.
class ScriptedMotion final : public Motion {
 public:
  ScriptedMotion(std::unique_ptr<Script> script, Rate rate, const MotionContext& context)
      : script_(std::move(script)),
        rate_(rate),
        last_step_(static_cast<std::int64_t>(std::ceil(script_->duration_s() * rate.Hz() - 1e-6))),
        context_(context) {
    SetInstant(script_->Eval(0));
    state_.v_step_W = state_.v_WB_W;
    if (context.route) piece_ = FindNearestPiece(*context.route, PointOnRoute());
    SetPlace();
  }

  Rate rate() const override { return rate_; }
  const TruthState& state() const override { return state_; }
  MotionStatus status() const override {
    return step_ < last_step_ ? MotionStatus::kRunning : MotionStatus::kArrived;
  }

  void Step() override {
    // k / rate, not the stamp: that is rounded to nanoseconds, which would show as jitter of the velocity
    const double dt_s = rate_.Period_s();
    const double begin_s = static_cast<double>(step_) * dt_s;
    const Quaterniond q_before = state_.X_WB.q;
    ++step_;
    state_.time = SampleTime(step_, rate_);
    SetInstant(script_->Eval(static_cast<double>(step_) * dt_s));
    state_.v_step_W = CalcMeanVelocity(*script_, begin_s, dt_s);
    state_.dtheta_B_rad = LogSO3(q_before.conjugate() * state_.X_WB.q);
    travelled_m_ += dt_s * state_.v_step_W.norm();
    SetPlace();
  }

 private:
  void SetInstant(const ScriptPoint& point) {
    state_.X_WB = point.X_WB;
    state_.v_WB_W = point.v_WB_W;
    state_.w_WB_B = point.w_WB_B;
    state_.f_WB_B = point.X_WB.q.conjugate() * (point.a_WB_W - context_.gravity_W);
    state_.contact = script_->contact();
  }

  Vector3d PointOnRoute() const { return state_.X_WB.p - script_->route_offset_W(); }

  /// The nearest point of the route, followed by continuity; without a route the distance travelled.
  void SetPlace() {
    state_.chainage_m = travelled_m_;
    if (!context_.route) return;
    const RouteSpot spot = FindRouteSpot(*context_.route, PointOnRoute(), piece_);
    piece_ = spot.piece;
    state_.chainage_m = std::clamp(spot.chainage_m, 0.0, context_.route->length_m());
    const RoutePiece& piece = context_.route->pieces()[piece_];
    state_.pipe = piece.pipe;
    state_.reversed = piece.reversed;
    state_.s_m = piece.PipeS_m(state_.chainage_m);
    if (context_.flow) SetWater(piece);
  }

  /// Speed along the route, the bulk velocity's across the whole bore; static gauge pressure rho (|g| head +
  /// g . p).
  void SetWater(const RoutePiece& piece) {
    const FlowPoint flow = context_.flow->Eval(state_.pipe, state_.s_m, state_.time);
    state_.water_speed_m_s = piece.reversed ? -flow.velocity_m_s : flow.velocity_m_s;
    state_.v_slip_W =
        flow.velocity_m_s * context_.network->pipe(state_.pipe).Eval(state_.s_m).tangent_W - state_.v_WB_W;
    state_.pressure_Pa = context_.water.density_kg_m3 *
                         (context_.gravity_W.norm() * flow.head_m + context_.gravity_W.dot(state_.X_WB.p));
  }

  std::unique_ptr<Script> script_;
  Rate rate_;
  std::int64_t last_step_;
  MotionContext context_;
  TruthState state_;
  std::size_t piece_ = 0;
  std::int64_t step_ = 0;
  double travelled_m_ = 0;
};

std::unique_ptr<Motion> Make(const Params& params, const MotionContext& context) {
  const auto& p = static_cast<const ScriptedParams&>(params);
  return std::make_unique<ScriptedMotion>(MakeScript(p, context), Rate(p.rate_Hz), context);
}

}  // namespace

MotionKind Kind() {
  return {"scripted",
          "A prescribed motion: timed waypoints, a rolling ball, a walk along the route, or rest.",
          MakeParams<ScriptedParams>, Make};
}

}  // namespace piperun::sim::motions::scripted
