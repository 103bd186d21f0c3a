#pragma once

#include <vector>

#include "base/network.h"
#include "sim/feature_shape.h"

namespace piperun::sim {

/// A pipe's end where it meets others. Vectors are in the axes of W; `p_end_L` lies in the pipe's own
/// drawing.
struct JointArm {
  PipeEnd end;
  Vector3d p_end_L;
  Vector3d outward;     ///< unit, from the node into the pipe
  double radius_m = 0;  ///< bore at the node
  double reach_m = 0;   ///< along the pipe: this far from the node the other arms' bores are felt
};

/// Where pipes meet at a node: the union of their bores, each taken as a straight tube that begins at the
/// node, and of a sphere around the node as wide as the widest of them, which closes the gaps that tubes
/// meeting at an angle would leave.
struct Joint {
  int node = -1;
  /// Two pipes go over into each other without a corner or a step: no wall but their own.
  bool smooth = false;
  double sphere_radius_m = 0;
  std::vector<JointArm> arms;

  bool dead_end() const { return arms.size() == 1; }
};

/// The inside of a network as water and ball find it: bores, and the joints where they meet.
///
/// Every pipe has its own drawing L: the frame W of the network, shifted. Where stated lengths differ from
/// drawn ones, the end of a pipe as drawn is not where the next begins, and what passes a joint is shifted
/// from one drawing into the next (ShiftAcross), so that lengths and directions hold everywhere.
class Bore {
 public:
  /// Keeps a reference. With `open` given, pipes that are not open do not exist for the ball: their openings
  /// are grated over at the joint, and what flows through them leaves the joint through its wall. So are
  /// pipes that let nothing solid through and leave a node within 0.1 rad of another one (pumps drawn side by
  /// side).
  explicit Bore(const Network& network, std::vector<bool> open = {});

  const Network& network() const { return network_; }
  const Joint& joint(int node) const { return joints_[static_cast<std::size_t>(node)]; }
  bool open(int pipe) const { return open_[static_cast<std::size_t>(pipe)]; }

  /// What stands on the walls or is cut into them; before anything is made from this bore.
  void SetFeatures(std::vector<WallFeature> features) { features_ = std::move(features); }
  const std::vector<WallFeature>& features() const { return features_; }

  /// The joint whose other arms are felt at `s_m` of a pipe; null along the rest of it, and at smooth joints.
  const Joint* FindJoint(int pipe, double s_m) const;
  /// True when a point (in the drawing of the spot's pipe) lies inside the bores.
  bool Contains(int pipe, double s_m, double offset_m, const Vector3d& p_L) const;
  /// Which arm of a joint an end is.
  const JointArm& FindArm(const Joint& joint, PipeEnd end) const;
  /// p in the drawing of `to`'s pipe = p in the drawing of `from`'s pipe + this; zero where the drawing
  /// closes.
  Vector3d ShiftAcross(PipeEnd from, PipeEnd to) const;

 private:
  Joint MakeJoint(int node) const;

  const Network& network_;
  std::vector<bool> open_;
  std::vector<Joint> joints_;  // per node
  std::vector<WallFeature> features_;
};

}  // namespace piperun::sim
