// What is rendered against the formulas it is rendered from, and against records of others.

#include <array>

#include "scenarios/sound/groups.h"

namespace piperun::scenarios {
namespace {

constexpr std::array<CheckGroup, 5> kGroups{sound::CheckLevels, sound::CheckPassage, sound::CheckStems,
                                            sound::CheckRealism, sound::CheckTee};

ReproduceReport Study(const ReproduceOptions& options) { return RunGroups(kGroups, "acoustics", options); }

}  // namespace

namespace reproductions::acoustics {
Reproduction Kind() {
  return {"acoustics",
          "The hydrophone's sound against the formulas and against published records: measured, expected, "
          "source; a leak near a tee",
          Study, true};
}
}  // namespace reproductions::acoustics

}  // namespace piperun::scenarios
