#pragma once

#include "scenarios/figure_checks.h"

namespace piperun::scenarios::physics {

// The groups, each a study of its own. docs/physics.md, "What checks it", tells what they are about.
void CheckDrag(const ReproduceOptions& options, ReproduceReport& report);
void CheckFall(const ReproduceOptions& options, ReproduceReport& report);
void CheckContact(const ReproduceOptions& options, ReproduceReport& report);
void CheckOrder(const ReproduceOptions& options, ReproduceReport& report);
void CheckCarried(const ReproduceOptions& options, ReproduceReport& report);
void CheckClosure(const ReproduceOptions& options, ReproduceReport& report);
void CheckTurbulence(const ReproduceOptions& options, ReproduceReport& report);

}  // namespace piperun::scenarios::physics
