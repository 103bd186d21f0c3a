#include "scenarios/key_path.h"

#include <charconv>
#include <sstream>

#include "base/check.h"

namespace piperun::scenarios {

std::vector<KeyStep> SplitKeyPath(const std::string& path) {
  std::vector<KeyStep> steps;
  std::stringstream parts(path);
  for (std::string part; std::getline(parts, part, '.');) {
    const std::size_t bracket = part.find('[');
    if (bracket != 0) steps.push_back({part.substr(0, bracket), {}});
    for (std::size_t open = bracket; open != std::string::npos; open = part.find('[', open + 1)) {
      std::size_t index = 0;
      const char* begin = part.data() + open + 1;
      const auto [end, error] = std::from_chars(begin, part.data() + part.size(), index);
      if (error != std::errc{} || end == part.data() + part.size() || *end != ']') {
        throw InputError("'" + path + "' is not a key path", "--set");
      }
      steps.push_back({"", index});
    }
  }
  return steps;
}

}  // namespace piperun::scenarios
