#pragma once

#include <string>
#include <vector>

#include "scenarios/scenario.h"

namespace piperun::scenarios {

/// Reads a scenario by path, or by its name in the catalogue, with the command line's overrides on top.
/// Throws InputError with file, line, key path, value, allowed range and, for an unknown key or name, the
/// nearest known one.
Scenario LoadScenario(const std::string& path_or_name, const std::vector<std::string>& overrides = {});

/// The same from a text; `file` stands in messages.
Scenario ParseScenario(const std::string& text, const std::string& file,
                       const std::vector<std::string>& overrides = {});

/// The effective scenario as YAML; reading it back gives the same run.
std::string WriteScenario(const Scenario& scenario);

}  // namespace piperun::scenarios
