#pragma once

#include <fmt/core.h>

#include <string>
#include <vector>

#include "tools/piperun/table.h"

namespace piperun::tools {

/// A table that stops at a screenful and says what is left out.
class LongTable {
 public:
  LongTable(std::vector<std::string> head, bool whole) : table_(std::move(head)), whole_(whole) {}
  void Add(std::vector<std::string> row) {
    if (whole_ || rows_ < kRows) table_.Add(std::move(row));
    ++rows_;
  }
  bool empty() const { return rows_ == 0; }
  std::string Text(const char* what) const {
    std::string text = table_.Text();
    if (!whole_ && rows_ > kRows) {
      text += fmt::format("  ... and {} more {}; --all prints them\n", rows_ - kRows, what);
    }
    return text;
  }

 private:
  static constexpr std::size_t kRows = 20;
  Table table_;
  bool whole_;
  std::size_t rows_ = 0;
};

}  // namespace piperun::tools
