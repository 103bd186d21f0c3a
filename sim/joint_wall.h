#pragma once

#include <vector>

#include "sim/bore.h"
#include "sim/joint_lip.h"

namespace piperun::sim {

/// The wall around a joint: boundary of the union of its members (sim/bore.h), and the plates in its arms.
/// Positions from the node N, in the axes of W.
///
/// The arms are half-tubes that begin at the node plane. An arm whose pipe is straight and too short to keep
/// the reaches of its two joints apart ends at its other node, and that node's sphere and other arms are
/// members, too. A pipe that bends within the reach of its joint counts as straight for the other arms.
class JointWall {
 public:
  JointWall(const Bore& bore, const Joint& joint);

  /// Adds the feet of p on all walls but the curved one of arm `own` (whoever is in that pipe knows its wall
  /// better), and on all edges.
  void AddFeet(const Vector3d& p_N, std::size_t own, double limit_m, double ring_m, WallFeet& feet) const;

  /// Whether q lies in the water, strictly, when arm `own` is not there.
  bool Covers(const Vector3d& q_N, std::size_t own) const;

  /// The deepest member around p: its depth (negative: p lies outside of all) and the way into it.
  struct Depth {
    double depth_m = 0;
    Vector3d inward;
  };
  Depth FindDepth(const Vector3d& p_N) const;

 private:
  void AddArms(const Bore& bore, const Joint& joint, const Vector3d& p_NJ, const PipeEnd* except);
  void AddNeighbour(const Bore& bore, const Joint& joint, std::size_t arm);
  void AddPlate(const BoreMember& tube, const Vector3d& p_N, WallFeet& feet) const;

  std::vector<BoreMember> members_;  // the joint's own arms first, in their order
  std::vector<JointLip> lips_;
};

/// How far from its end the plate sits that shuts a pipe which lets nothing solid through: one radius, and
/// behind the reach of the joint, so that it narrows no other bore; at most in the middle.
double CalcPlate_m(const Pipe& pipe, const JointArm& arm);

}  // namespace piperun::sim
