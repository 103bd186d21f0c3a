#pragma once

#include <optional>
#include <string>
#include <vector>

namespace piperun::scenarios {

/// One step of a key path: a key, or the index of a list's item.
struct KeyStep {
  std::string key;
  std::optional<std::size_t> index;
};

/// "leaks[0].s_m" -> leaks, 0, s_m. Throws InputError when the text is not such a path.
std::vector<KeyStep> SplitKeyPath(const std::string& path);

}  // namespace piperun::scenarios
