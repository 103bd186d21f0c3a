// The physics of the ball against laws that can be derived by hand and against published figures.

#include <array>

#include "scenarios/parallel.h"
#include "scenarios/physics/checks.h"

namespace piperun::scenarios {
namespace {

using Group = void (*)(const ReproduceOptions&, ReproduceReport&);
constexpr std::array<Group, 7> kGroups{physics::CheckDrag,      physics::CheckFall,    physics::CheckContact,
                                       physics::CheckOrder,     physics::CheckCarried, physics::CheckClosure,
                                       physics::CheckTurbulence};

ReproduceReport Study(const ReproduceOptions& options) {
  std::array<ReproduceReport, kGroups.size()> parts;
  RunParallel(
      static_cast<int>(kGroups.size()), options.jobs, options.stop,
      [&](int i) { kGroups[static_cast<std::size_t>(i)](options, parts[static_cast<std::size_t>(i)]); },
      [&](double fraction) {
        if (options.progress) options.progress(fraction, "physics");
      });
  ReproduceReport report;
  for (ReproduceReport& part : parts) {
    std::move(part.tables.begin(), part.tables.end(), std::back_inserter(report.tables));
    std::move(part.figures.begin(), part.figures.end(), std::back_inserter(report.figures));
  }
  return report;
}

}  // namespace

namespace reproductions::physics {
Reproduction Kind() {
  return {"physics",
          "The ball's physics against hand-derived laws and published figures: measured, expected, source",
          Study};
}
}  // namespace reproductions::physics

}  // namespace piperun::scenarios
