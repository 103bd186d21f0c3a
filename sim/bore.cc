#include "sim/bore.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"

namespace piperun::sim {
namespace {

constexpr double kMaxKink_rad = 1e-6;  // below this two pipes are one
constexpr double kMaxGap_m = 1e-9;     // below this two drawings are one
constexpr double kMinBranching_rad = 0.1;

/// How far along arm `a` the bore of arm `b` may still be open towards it.
double CalcReach_m(const JointArm& a, const JointArm& b) {
  const double cosine = a.outward.dot(b.outward);
  if (cosine <= 0) return b.radius_m;
  const double angle = std::max(kMinBranching_rad, std::acos(std::min(1.0, cosine)));
  return (b.radius_m + a.radius_m * std::cos(angle)) / std::sin(angle);
}

bool IsSmooth(const std::vector<JointArm>& arms) {
  if (arms.size() != 2 || arms[0].radius_m != arms[1].radius_m) return false;
  const Vector3d &a = arms[0].outward, b = -arms[1].outward;
  return std::atan2(a.cross(b).norm(), a.dot(b)) <= kMaxKink_rad;
}

/// Whether a pipe leaves one of its nodes nearly along another one.
bool HasTwin(const Network& network, int pipe) {
  for (const PipeEnd end : {PipeEnd{pipe, false}, PipeEnd{pipe, true}}) {
    const Vector3d way = network.pipe(pipe).Inward(end.at_to);
    for (const PipeEnd& other : network.EndsAt(network.NodeAt(end))) {
      if (other == end) continue;
      if (way.dot(network.pipe(other.pipe).Inward(other.at_to)) > std::cos(kMinBranching_rad)) return true;
    }
  }
  return false;
}

/// Pumps stand side by side in drawings: nothing solid passes them, so where they open matters little.
std::vector<bool> CloseImpassableTwins(const Network& network, std::vector<bool> open) {
  if (open.empty()) open.assign(network.pipes().size(), true);
  for (std::size_t i = 0; i < open.size(); ++i) {
    if (!network.pipes()[i].passable && HasTwin(network, static_cast<int>(i))) open[i] = false;
  }
  return open;
}

}  // namespace

Bore::Bore(const Network& network, std::vector<bool> open)
    : network_(network), open_(CloseImpassableTwins(network, std::move(open))) {
  Demand(open_.size() == network.pipes().size(), "a mask names every pipe");
  for (std::size_t node = 0; node < network.nodes().size(); ++node) {
    joints_.push_back(MakeJoint(static_cast<int>(node)));
  }
}

Joint Bore::MakeJoint(int node) const {
  Joint joint;
  joint.node = node;
  for (const PipeEnd& end : network_.EndsAt(node)) {
    if (!open(end.pipe)) continue;
    const Pipe& pipe = network_.pipe(end.pipe);
    const double s_m = pipe.EndS_m(end.at_to);
    joint.arms.push_back({end, pipe.Eval(s_m).p_W, pipe.Inward(end.at_to), pipe.RadiusAt_m(s_m), 0});
    joint.sphere_radius_m = std::max(joint.sphere_radius_m, joint.arms.back().radius_m);
  }
  joint.smooth = IsSmooth(joint.arms);
  if (joint.smooth) return joint;
  for (JointArm& arm : joint.arms) {
    arm.reach_m = joint.sphere_radius_m;
    for (const JointArm& other : joint.arms) {
      if (&other != &arm) arm.reach_m = std::max(arm.reach_m, CalcReach_m(arm, other));
    }
  }
  return joint;
}

const Joint* Bore::FindJoint(int pipe, double s_m) const {
  const Pipe& p = network_.pipe(pipe);
  const bool at_to = s_m > 0.5 * p.length_m;
  const Joint& near = joint(at_to ? p.to : p.from);
  if (near.smooth) return nullptr;
  const double from_end_m = at_to ? p.length_m - s_m : s_m;
  return from_end_m < FindArm(near, {pipe, at_to}).reach_m ? &near : nullptr;
}

bool Bore::Contains(int pipe, double s_m, double offset_m, const Vector3d& p_L) const {
  const Pipe& p = network_.pipe(pipe);
  if (offset_m <= p.RadiusAt_m(s_m) && s_m >= 0 && s_m <= p.length_m) return true;
  const Joint* near = FindJoint(pipe, s_m);
  if (!near) return false;
  const Vector3d p_N = p_L - FindArm(*near, {pipe, s_m > 0.5 * p.length_m}).p_end_L;
  return p_N.norm() <= near->sphere_radius_m ||
         std::any_of(near->arms.begin(), near->arms.end(), [&](const JointArm& arm) {
           const double along = p_N.dot(arm.outward);
           return along >= 0 && (p_N - along * arm.outward).norm() <= arm.radius_m;
         });
}

const JointArm& Bore::FindArm(const Joint& joint, PipeEnd end) const {
  const auto found =
      std::find_if(joint.arms.begin(), joint.arms.end(), [&](const JointArm& arm) { return arm.end == end; });
  Demand(found != joint.arms.end(), "an end is an arm of the joint at its node");
  return *found;
}

Vector3d Bore::ShiftAcross(PipeEnd from, PipeEnd to) const {
  const Joint& at = joint(network_.NodeAt(from));
  const Vector3d shift = FindArm(at, to).p_end_L - FindArm(at, from).p_end_L;
  return shift.norm() > kMaxGap_m ? shift : Vector3d::Zero();
}

}  // namespace piperun::sim
