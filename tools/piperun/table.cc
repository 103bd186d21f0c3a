#include "tools/piperun/table.h"

#include <fmt/core.h>

#include <algorithm>

namespace piperun::tools {
namespace {

using Rows = std::vector<std::vector<std::string>>;

std::size_t Width(const Rows& rows, std::size_t column) {
  std::size_t width = 0;
  for (const auto& row : rows) width = std::max(width, row[column].size());
  return width;
}

bool IsNumeric(const Rows& rows, std::size_t column) {
  return std::all_of(rows.begin() + 1, rows.end(), [column](const auto& row) {
    return row[column].find_first_not_of("+-.0123456789e%") == std::string::npos;
  });
}

std::string RightTrimmed(std::string text) {
  text.erase(text.find_last_not_of(' ') + 1);
  return text;
}

}  // namespace

std::string Table::Text() const {
  const std::size_t columns = rows_.front().size();
  Rows rows = rows_;
  rows.insert(rows.begin() + 1, std::vector<std::string>(columns));
  for (std::size_t c = 0; c < columns; ++c) rows[1][c] = std::string(Width(rows_, c), '-');
  std::string text;
  for (const auto& row : rows) {
    std::string line;
    for (std::size_t c = 0; c < columns; ++c) {
      line += "  ";
      line += IsNumeric(rows_, c) ? fmt::format("{:>{}}", row[c], Width(rows_, c))
                                  : fmt::format("{:<{}}", row[c], Width(rows_, c));
    }
    text += RightTrimmed(line) + "\n";
  }
  return text;
}

}  // namespace piperun::tools
