#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace piperun::scenarios {

/// How the stamps of a file go on from row to row.
enum class StampOrder { kRise, kDoNotFall };

/// Reads a CSV file of an integer stamp and doubles, row by row.
class CsvReader {
 public:
  /// Throws InputError when the file cannot be read or does not begin with exactly this header.
  CsvReader(const std::filesystem::path& path, std::string_view header, StampOrder order = StampOrder::kRise);
  /// Fills the stamp and exactly values.size() numbers; `text` (when given) takes the column after the stamp
  /// instead of a number. False at the end. Throws InputError with file and line for a broken row.
  bool Next(std::int64_t& stamp_ns, std::span<double> values, std::string* text = nullptr);
  /// Throws InputError with file and line of the last row.
  [[noreturn]] void Refuse(const std::string& problem) const;

 private:
  bool ReadLine();
  void CheckOrder(std::int64_t stamp_ns);

  std::filesystem::path path_;
  StampOrder order_;
  std::ifstream file_;
  std::string line_;
  std::int64_t line_number_ = 0;
  std::optional<std::int64_t> before_ns_;
};

}  // namespace piperun::scenarios
