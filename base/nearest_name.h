#pragma once

#include <optional>
#include <string>
#include <vector>

namespace piperun {

/// The name a user most likely meant: fewest edits (Levenshtein), of equals the one that begins alike the
/// longest; or nothing when more than half of the letters would have to change.
std::optional<std::string> FindNearestName(const std::string& written, const std::vector<std::string>& known);

}  // namespace piperun
