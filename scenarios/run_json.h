#pragma once

#include <filesystem>
#include <string>

#include "scenarios/run.h"

namespace piperun::scenarios {

/// Version of piperun, as CMake knows it.
std::string_view Version();

/// SHA-256 of every file below a folder but run.json.
std::map<std::string, std::string> HashFiles(const std::filesystem::path& folder);

std::string WriteRunJson(const RunResult& result);

/// What a run.json says of the run itself: scenario, seed, run index, status, duration, route,
/// collisions. Throws InputError when it is not the run.json of a run.
RunResult LoadRunSummary(const std::string& json);

/// The value at a JSON pointer as a number, and as text; nothing when it is not there.
struct JsonValue {
  std::optional<double> number;
  std::optional<std::string> text;
};
JsonValue FindJson(const std::string& json, const std::string& pointer);

}  // namespace piperun::scenarios
