// The physics of the ball against laws that can be derived by hand and against published figures.

#include <array>

#include "scenarios/physics/groups.h"

namespace piperun::scenarios {
namespace {

constexpr std::array<CheckGroup, 7> kGroups{
    physics::CheckDrag,    physics::CheckFall,    physics::CheckContact,   physics::CheckOrder,
    physics::CheckCarried, physics::CheckClosure, physics::CheckTurbulence};

ReproduceReport Study(const ReproduceOptions& options) { return RunGroups(kGroups, "physics", options); }

}  // namespace

namespace reproductions::physics {
Reproduction Kind() {
  return {"physics",
          "The ball's physics against hand-derived laws and published figures: measured, expected, source",
          Study};
}
}  // namespace reproductions::physics

}  // namespace piperun::scenarios
