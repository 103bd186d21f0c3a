#pragma once

#include <string>
#include <vector>

#include "scenarios/detectors/study.h"
#include "scenarios/reproduction.h"

namespace piperun::scenarios::detectors {

/// Rows of leaks: pipe, loudness, locator, share found with Wilson's interval, errors, coverage, flow.
ReproducedTable TabulateFound(const std::vector<Tally>& tallies);
/// False alarms per kilometre of each pipe and locator, all loudnesses together, with their interval.
ReproducedTable TabulateFalseAlarms(const std::vector<Tally>& tallies);
/// One row per tally, plain numbers.
std::string WriteStudyCsv(const std::vector<Tally>& tallies);
/// Share found over loudness, one panel per pipe, one line per locator with Wilson's interval.
std::string DrawStudySvg(const std::vector<Tally>& tallies);

}  // namespace piperun::scenarios::detectors
