#include "base/bend_fit.h"

#include <algorithm>

namespace piperun {
namespace {

const BendSide& SideOn(const BendDemand& bend, int straight) {
  return bend.sides[0].straight == straight ? bend.sides[0] : bend.sides[1];
}

/// What a bend may take of the straight at one of its sides.
double CalcShare_m(const BendSide& side, const std::vector<BendStraight>& straights,
                   const std::vector<BendDemand>& bends) {
  const BendStraight& straight = straights[static_cast<std::size_t>(side.straight)];
  const auto far = static_cast<std::size_t>(1 - side.end);
  const double room_m =
      std::min(kBendableShare * straight.length_m, straight.length_m - straight.kept_m[far]);
  if (straight.bend[far] < 0) return room_m;
  const BendDemand& other = bends[static_cast<std::size_t>(straight.bend[far])];
  const double rest_m = room_m - other.radius_m * SideOn(other, side.straight).per_radius;
  return other.may_shrink ? std::max(0.5 * room_m, rest_m) : rest_m;
}

}  // namespace

std::vector<double> CalcFittingRadii(const std::vector<BendStraight>& straights,
                                     const std::vector<BendDemand>& bends) {
  std::vector<double> radii_m;
  for (const BendDemand& bend : bends) {
    double radius_m = bend.radius_m;
    if (bend.may_shrink) {
      for (const BendSide& side : bend.sides) {
        const double share_m = std::max(0.0, CalcShare_m(side, straights, bends));
        radius_m = std::min(radius_m, share_m / side.per_radius);
      }
    }
    radii_m.push_back(radius_m);
  }
  return radii_m;
}

}  // namespace piperun
