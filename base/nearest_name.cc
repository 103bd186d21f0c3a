#include "base/nearest_name.h"

#include <algorithm>
#include <numeric>

namespace piperun {
namespace {

std::size_t EditDistance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replace = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, replace});
    }
  }
  return row.back();
}

std::ptrdiff_t CommonPrefix(const std::string& a, const std::string& b) {
  return std::mismatch(a.begin(), a.end(), b.begin(), b.end()).first - a.begin();
}

}  // namespace

std::optional<std::string> FindNearestName(const std::string& written,
                                           const std::vector<std::string>& known) {
  std::optional<std::string> nearest;
  std::size_t fewest = std::max<std::size_t>(written.size() / 2, 1) + 1;
  for (const std::string& name : known) {
    const std::size_t edits = EditDistance(written, name);
    const bool alike =
        nearest && edits == fewest && CommonPrefix(written, name) > CommonPrefix(written, *nearest);
    if (edits < fewest || alike) {
      fewest = edits;
      nearest = name;
    }
  }
  return nearest;
}

}  // namespace piperun
