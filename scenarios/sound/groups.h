#pragma once

#include <filesystem>

#include "scenarios/figure_checks.h"

namespace piperun::scenarios::sound {

// The groups, each a study of its own. docs/acoustics.md, "What checks it", tells what they are about.
void CheckLevels(const ReproduceOptions& options, ReproduceReport& report);
void CheckPassage(const ReproduceOptions& options, ReproduceReport& report);
void CheckStems(const ReproduceOptions& options, ReproduceReport& report);
void CheckRealism(const ReproduceOptions& options, ReproduceReport& report);
/// Draws tee.svg into options.out, where that is given.
void CheckTee(const ReproduceOptions& options, ReproduceReport& report);

}  // namespace piperun::scenarios::sound
