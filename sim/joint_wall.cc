#include "sim/joint_wall.h"

#include <algorithm>

namespace piperun::sim {
namespace {

constexpr double kStrictly_m = 1e-12;  // rounding of a foot, with room

/// The joint at the other end of an arm's pipe, when what is around there is felt here: null otherwise.
const Joint* FindNeighbour(const Bore& bore, const JointArm& arm) {
  const Pipe& pipe = bore.network().pipe(arm.end.pipe);
  if (pipe.centreline.size() != 1 || !pipe.centreline.front().straight()) return nullptr;
  const PipeEnd far{arm.end.pipe, !arm.end.at_to};
  const Joint& joint = bore.joint(bore.network().NodeAt(far));
  if (joint.smooth) return nullptr;
  const double felt_m = arm.reach_m + bore.FindArm(joint, far).reach_m + pipe.diameter_m;
  return pipe.length_m < felt_m ? &joint : nullptr;
}

}  // namespace

double CalcPlate_m(const Pipe& pipe, const JointArm& arm) {
  return std::min(0.5 * pipe.length_m, std::max(arm.radius_m, arm.reach_m));
}

JointWall::JointWall(const Bore& bore, const Joint& joint) {
  AddArms(bore, joint, Vector3d::Zero(), nullptr);
  members_.push_back({.radius_m = joint.sphere_radius_m});
  for (std::size_t arm = 0; arm < joint.arms.size(); ++arm) AddNeighbour(bore, joint, arm);
  for (std::size_t i = 0; i < members_.size(); ++i) {
    if (members_[i].sphere()) continue;
    JointLip lip(members_, i);
    if (lip.exists()) lips_.push_back(lip);
  }
}

void JointWall::AddArms(const Bore& bore, const Joint& joint, const Vector3d& p_NJ, const PipeEnd* except) {
  for (const JointArm& arm : joint.arms) {
    if (except && arm.end == *except) continue;
    BoreMember tube{.origin = p_NJ, .axis = arm.outward, .radius_m = arm.radius_m};
    const Pipe& pipe = bore.network().pipe(arm.end.pipe);
    if (!pipe.passable) tube.plate_m = CalcPlate_m(pipe, arm);
    members_.push_back(tube);
  }
}

void JointWall::AddNeighbour(const Bore& bore, const Joint& joint, std::size_t arm) {
  const JointArm& to = joint.arms[arm];
  const Joint* neighbour = FindNeighbour(bore, to);
  if (!neighbour) return;
  const double length_m = bore.network().pipe(to.end.pipe).length_m;
  const PipeEnd far{to.end.pipe, !to.end.at_to};
  members_[arm].length_m = length_m;
  AddArms(bore, *neighbour, length_m * to.outward, &far);
  members_.push_back({.origin = length_m * to.outward, .radius_m = neighbour->sphere_radius_m});
}

bool JointWall::Covers(const Vector3d& q_N, std::size_t own) const {
  for (std::size_t i = 0; i < members_.size(); ++i) {
    if (i != own && CalcDepth(members_[i], q_N) > kStrictly_m) return true;
  }
  return false;
}

void JointWall::AddFeet(const Vector3d& p_N, std::size_t own, double limit_m, double ring_m,
                        WallFeet& feet) const {
  for (std::size_t i = 0; i < members_.size(); ++i) {
    const BoreMember& member = members_[i];
    AddPlate(member, p_N, feet);
    WallFoot foot;
    if (i == own || !FindWallFoot(member, p_N, foot) || foot.distance_m > limit_m) continue;
    if (!Covers(p_N - foot.distance_m * foot.normal, i)) feet.Add(foot);
  }
  for (const JointLip& lip : lips_) lip.AddFeet(members_, p_N, limit_m, ring_m, feet);
}

void JointWall::AddPlate(const BoreMember& tube, const Vector3d& p_N, WallFeet& feet) const {
  if (tube.plate_m == std::numeric_limits<double>::infinity()) return;
  const double along = (p_N - tube.origin).dot(tube.axis);
  if (along > tube.plate_m) return;  // what is behind it comes from elsewhere
  if ((p_N - tube.origin - along * tube.axis).norm() > tube.radius_m) return;
  feet.Add({-tube.axis, tube.plate_m - along, WallFoot::Kind::kPlane});
}

JointWall::Depth JointWall::FindDepth(const Vector3d& p_N) const {
  Depth deepest{-std::numeric_limits<double>::infinity(), Vector3d::Zero()};
  const BoreMember* best = nullptr;
  for (const BoreMember& member : members_) {
    const double depth_m = CalcDepth(member, p_N);
    if (depth_m <= deepest.depth_m) continue;
    deepest.depth_m = depth_m;
    best = &member;
  }
  if (deepest.depth_m <= 0) deepest.inward = CalcDeepening(*best, p_N);
  return deepest;
}

}  // namespace piperun::sim
