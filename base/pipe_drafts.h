#pragma once

#include <array>
#include <optional>
#include <vector>

#include "base/pipe_layout.h"

namespace piperun {

/// A bend between two pipes.
struct JointBend {
  std::array<PipeEnd, 2> end;
  std::array<double, 2> part;  ///< of the arc, in each of the two pipes; together one
  double turn_rad = 0;
  double radius_m = 0;  ///< wanted
};

/// The lines of a network's pipes before their corners are rounded, and which corners there are. Keeps the
/// plan by reference.
class PipeDrafts {
 public:
  explicit PipeDrafts(const NetworkPlan& plan);

  const NetworkPlan& plan() const { return plan_; }
  const PipeSpec& spec(int pipe) const { return plan_.specs[static_cast<std::size_t>(pipe)]; }
  const Polyline& line(int pipe) const { return drafts_[static_cast<std::size_t>(pipe)].line; }
  /// Direction of a line at its end, into the pipe.
  Vector3d Inward(PipeEnd end) const;
  /// Index of the straight at a line's end.
  std::size_t StraightAt(PipeEnd end) const;
  int NodeAt(PipeEnd end) const;
  const std::vector<PipeEnd>& EndsAt(int node) const { return plan_.ends[static_cast<std::size_t>(node)]; }

  /// The bend at a node where two pipes meet alone, at an angle that is to be rounded.
  std::optional<JointBend> FindJointBend(int node) const;
  /// Whether a pipe ends at a junction, or at a corner that stays sharp.
  bool EndsSharp(PipeEnd end) const;

  /// Leaves an inner vertex out of a line and stretches it again.
  void DropVertex(int pipe, std::size_t vertex);
  /// Leaves the corner at a node sharp.
  void Mitre(int node) { mitred_[static_cast<std::size_t>(node)] = true; }

 private:
  struct Draft {
    std::vector<Vector3d> drawn_W;
    Polyline line;  ///< of the stated length
  };
  Draft& draft(int pipe) { return drafts_[static_cast<std::size_t>(pipe)]; }
  void Draw(int pipe);

  const NetworkPlan& plan_;
  std::vector<Draft> drafts_;
  std::vector<bool> mitred_;  // per node
};

/// "network.pipes[3]".
std::string PipeKey(int pipe);

}  // namespace piperun
