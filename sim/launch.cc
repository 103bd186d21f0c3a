#include "sim/launch.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "base/number.h"
#include "base/random.h"
#include "sim/pipe_flow.h"

namespace piperun::sim {
namespace {

const Pipe& LaunchPipe(const MotionContext& context) { return context.network->pipe(context.launch.pipe); }

/// Across the pipe, the way gravity pulls; in a vertical pipe any direction across.
Vector3d FindDown(const Vector3d& gravity_W, const Vector3d& tangent_W) {
  const Vector3d across = gravity_W - gravity_W.dot(tangent_W) * tangent_W;
  if (across.norm() > 1e-9 * gravity_W.norm()) return across.normalized();
  return tangent_W.unitOrthogonal();
}

/// How far into the launch pipe the ball is put: clear of whatever else opens at the node.
double LaunchDistance_m(const MotionContext& context) {
  const Joint& joint = context.bore->joint(context.network->NodeAt(context.launch));
  if (joint.smooth || joint.dead_end()) return 0;
  const double clear_m = context.bore->FindArm(joint, context.launch).reach_m + context.ball.radius_m;
  return std::min(clear_m, 0.5 * LaunchPipe(context).length_m);
}

}  // namespace

BallStart MakeLaunch(const MotionContext& context, double lateral_sd_m) {
  const Pipe& pipe = LaunchPipe(context);
  BallStart start;
  start.spot.pipe = context.launch.pipe;
  const double from_node_m = LaunchDistance_m(context);
  start.spot.s_m = context.launch.at_to ? pipe.length_m - from_node_m : from_node_m;
  start.spot.piece = pipe.FindPiece(start.spot.s_m);
  start.spot.axis = EvalCentreline(pipe.centreline[start.spot.piece], start.spot.s_m);
  const double bore_radius_m = pipe.RadiusAt_m(start.spot.s_m);
  const double sense = context.launch.at_to ? -1 : 1;
  const Vector3d x = sense * start.spot.axis.tangent_W, z = -FindDown(context.gravity_W, x), y = z.cross(x);
  const double draw = RandomStream(context.seed, "launch", context.run).Normals(0, 0)[0];
  const double angle = lateral_sd_m * draw / bore_radius_m;
  Matrix3d R_WB;
  R_WB << x, y, z;
  const Vector3d towards_wall = std::sin(angle) * y - std::cos(angle) * z;
  start.X_LB = {start.spot.axis.p_W + (bore_radius_m - context.ball.radius_m) * towards_wall,
                Quaterniond(R_WB).normalized()};
  return start;
}

bool Fits(const BallParams& ball, double bore_radius_m) {
  return ball.radius_m <= kMaxDiameterRatio * bore_radius_m;
}

void RequireFit(const MotionContext& context) {
  const double bore_radius_m = LaunchPipe(context).radius_m();
  if (Fits(context.ball, bore_radius_m)) return;
  throw InputError("the ball's radius is " + FormatNumber(context.ball.radius_m) + " m; in a bore of " +
                       FormatNumber(2 * bore_radius_m) + " m it must lie in (0, " +
                       FormatNumber(kMaxDiameterRatio * bore_radius_m) + "] m",
                   "ball.radius_m");
}

}  // namespace piperun::sim
