#pragma once

#include <array>
#include <vector>

namespace piperun {

/// A straight between two vertices, and which bends want a part of it.
struct BendStraight {
  double length_m = 0;
  std::array<int, 2> bend{-1, -1};     ///< at its beginning and its end; -1: none
  std::array<double, 2> kept_m{0, 0};  ///< must stay straight beside an end without a bend
};

/// Where a bend meets a straight.
struct BendSide {
  int straight = 0;
  int end = 0;            ///< of the straight: 0 beginning, 1 end
  double per_radius = 0;  ///< length it takes per metre of its radius: tan(theta/2), or more
};

struct BendDemand {
  double radius_m = 0;      ///< wanted
  bool may_shrink = false;  ///< else it is built as wanted, and others make room
  std::array<BendSide, 2> sides;
};

/// This part of a straight may be taken by bends; the rest takes up the changes of length.
inline constexpr double kBendableShare = 0.9;

/// The radius of every bend that lets all fit: as wanted, or what a fair share of the straights beside it
/// allows. Where both bends of a straight want more than is there, each gets half, and what one does not need
/// goes to the other. Depends on no order.
std::vector<double> CalcFittingRadii(const std::vector<BendStraight>& straights,
                                     const std::vector<BendDemand>& bends);

}  // namespace piperun
