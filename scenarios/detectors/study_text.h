#pragma once

#include <string>
#include <vector>

#include "scenarios/detectors/study.h"
#include "scenarios/reproduction.h"

namespace piperun::scenarios::detectors {

/// Rows of leaks: pipe, loudness, locator, share found with Wilson's interval, errors, coverage, flow.
ReproducedTable TabulateFound(const std::vector<Tally>& tallies);
/// False alarms per kilometre of each pipe and locator, all loudnesses together.
ReproducedTable TabulateFalseAlarms(const std::vector<Tally>& tallies);
/// Share that the matched filter finds over a leak's flow, by pipe and pressure: the jet's SNR from the
/// model, the share at that SNR from the tallies.
ReproducedTable TabulateFlows(const std::vector<Tally>& tallies);
/// One row per tally, plain numbers.
std::string WriteStudyCsv(const std::vector<Tally>& tallies);
/// Share found over loudness, one panel per pipe, one line per locator with Wilson's interval.
std::string DrawStudySvg(const std::vector<Tally>& tallies);

}  // namespace piperun::scenarios::detectors
