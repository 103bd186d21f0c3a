#pragma once

#include <string>
#include <vector>

namespace piperun::tools {

/// A plain-text table whose columns line up; a column whose cells all are numbers (or '-') stands to the
/// right.
class Table {
 public:
  explicit Table(std::vector<std::string> head) : rows_{std::move(head)} {}
  void Add(std::vector<std::string> row) { rows_.push_back(std::move(row)); }
  bool empty() const { return rows_.size() == 1; }
  std::string Text() const;

 private:
  std::vector<std::vector<std::string>> rows_;  // the head first
};

}  // namespace piperun::tools
