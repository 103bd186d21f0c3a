#include "sim/network_spot.h"

namespace piperun::sim {
namespace {

/// The spot in one pipe, looked for from a piece on.
NetworkSpot FindSpotInPipe(const Network& network, int pipe, const Vector3d& p_L, std::size_t piece) {
  const std::vector<CentrelinePiece>& pieces = network.pipe(pipe).centreline;
  std::size_t i = piece;
  double s = FindNearest(pieces[i], p_L);
  // one way only: at a seam, rounding may let each of two neighbours point at the other
  if (s >= pieces[i].s_end_m()) {
    while (i + 1 < pieces.size() && s >= pieces[i].s_end_m()) s = FindNearest(pieces[++i], p_L);
  } else {
    while (i > 0 && s < pieces[i].s_begin_m) s = FindNearest(pieces[--i], p_L);
  }
  return {pipe, i, s, EvalCentreline(pieces[i], s)};
}

/// How deep a point (from the node) lies in an arm: offset from its axis over its radius; above 1: outside.
/// Nothing when the point is not on the arm's side of the node.
std::optional<double> CalcDepth(const JointArm& arm, const Vector3d& p_N) {
  const double along = p_N.dot(arm.outward);
  if (along < 0) return std::nullopt;
  return (p_N - along * arm.outward).norm() / arm.radius_m;
}

/// The arm into which a point has gone that was in `current`; null: it is still there.
const JointArm* FindEntered(const Joint& joint, const JointArm& current, const Vector3d& p_N, bool passed,
                            double offset_m) {
  if (joint.dead_end()) return nullptr;
  if (joint.smooth) return !passed ? nullptr : &joint.arms[joint.arms[0].end == current.end ? 1 : 0];
  if (!passed && offset_m <= current.radius_m) return nullptr;
  const JointArm* best = nullptr;
  double best_depth = 1;
  for (const JointArm& arm : joint.arms) {
    const auto depth = arm.end == current.end ? std::nullopt : CalcDepth(arm, p_N);
    if (!depth || *depth >= best_depth) continue;
    best = &arm;
    best_depth = *depth;
  }
  return best;
}

}  // namespace

SpotMove FindNetworkSpot(const Bore& bore, const Vector3d& p_L, const NetworkSpot& hint) {
  const Network& network = bore.network();
  const NetworkSpot spot = FindSpotInPipe(network, hint.pipe, p_L, hint.piece);
  const Pipe& pipe = network.pipe(spot.pipe);
  const bool at_to = spot.s_m > 0.5 * pipe.length_m;
  const bool passed = at_to ? spot.s_m >= pipe.length_m : spot.s_m < 0;
  if (!passed && !bore.FindJoint(spot.pipe, spot.s_m)) return {spot, std::nullopt};
  const PipeEnd left{spot.pipe, at_to};
  const Joint& joint = bore.joint(network.NodeAt(left));
  const JointArm& arm = bore.FindArm(joint, left);
  const JointArm* entered = FindEntered(joint, arm, p_L - arm.p_end_L, passed, (p_L - spot.axis.p_W).norm());
  if (!entered) return {spot, std::nullopt};
  const SpotMove::Crossing crossing{left, entered->end, bore.ShiftAcross(left, entered->end)};
  const std::size_t piece =
      crossing.entered.at_to ? network.pipe(crossing.entered.pipe).centreline.size() - 1 : 0;
  return {FindSpotInPipe(network, crossing.entered.pipe, p_L + crossing.shift_L, piece), crossing};
}

}  // namespace piperun::sim
