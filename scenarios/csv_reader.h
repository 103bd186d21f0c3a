#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <span>
#include <string>

namespace piperun::scenarios {

/// Reads a CSV file of an integer stamp and doubles, row by row. Lines that begin with '#' are skipped.
class CsvReader {
 public:
  /// Throws InputError when the file cannot be read.
  explicit CsvReader(const std::filesystem::path& path);
  /// Fills the stamp and exactly values.size() numbers; `text` (when given) takes the column after the stamp
  /// instead of a number. False at the end. Throws InputError with file and line for a broken row.
  bool Next(std::int64_t& stamp_ns, std::span<double> values, std::string* text = nullptr);

 private:
  [[noreturn]] void Refuse(const std::string& problem) const;

  std::filesystem::path path_;
  std::ifstream file_;
  std::string line_;
  std::int64_t line_number_ = 0;
};

}  // namespace piperun::scenarios
