#pragma once

#include <array>
#include <optional>

#include "base/network.h"

namespace piperun::sim {

/// The drawing of a pipe, moved so that it meets the drawing of another pipe at the node they share. Where
/// lengths are stated, a network's drawings are stretched each for itself and need not meet (see Network);
/// what is near the joint would then be metres off. One pipe with itself, and pipes that share no node, stay
/// where they are drawn.
class JoinedDrawing {
 public:
  /// `pipe` as seen from the drawing of `fixed`.
  JoinedDrawing(const Network& network, int fixed, int pipe);

  /// p in the drawing of `fixed` = p in the drawing of `pipe` + this, next to s along `pipe`: where the pipes
  /// share both nodes, the nearer one counts. W.
  Vector3d Shift_W(double s_m) const;
  /// Whether the drawings meet: the pipes share a node, or are one.
  bool meets() const { return shifts_W_[0] || shifts_W_[1]; }

 private:
  double middle_m_;
  std::array<std::optional<Vector3d>, 2> shifts_W_;  ///< by the `from` and by the `to` end of `pipe`
};

}  // namespace piperun::sim
