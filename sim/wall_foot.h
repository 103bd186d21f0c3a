#pragma once

#include <array>
#include <cstddef>

#include "base/pose.h"

namespace piperun::sim {

/// A point q of a wall seen from a point p: q = p - distance n.
struct WallFoot {
  enum class Kind {
    kSheet,  ///< locally nearest on a wall or on an edge: moves along with p
    kPoint,  ///< a fixed point of an edge
    kPlane   ///< a flat wall, or a tangent plane that the fluid lies on one side of
  };
  Vector3d normal;        ///< unit, from the wall into the water
  double distance_m = 0;  ///< negative: p lies behind the wall
  Kind kind = Kind::kSheet;
  int feature = -1;  ///< index of the wall feature it belongs to; -1: the wall itself
  int body = -1;     ///< which of the bodies that stand on the wall it is on; -1: the wall and its edges
};

/// The nearest few feet of one point, each once.
class WallFeet {
 public:
  static constexpr std::size_t kCapacity = 8;

  /// Keeps the foot unless it is there already, or the list is full of nearer ones.
  void Add(const WallFoot& foot);

  const WallFoot* begin() const { return feet_.data(); }
  const WallFoot* end() const { return feet_.data() + size_; }
  std::size_t size() const { return size_; }

 private:
  std::array<WallFoot, kCapacity> feet_;
  std::size_t size_ = 0;
};

}  // namespace piperun::sim
