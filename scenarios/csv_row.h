#pragma once

#include <charconv>
#include <cstdint>
#include <optional>
#include <string_view>

#include "base/number.h"
#include "base/pose.h"
#include "scenarios/output_file.h"

namespace piperun::scenarios {

/// Ends a CsvRow.
struct EndOfRow {};
inline constexpr EndOfRow kEndOfRow;

/// One row of a CSV file: values separated by commas, doubles in shortest round-trip decimals, ended by
/// kEndOfRow (which may write to the disk, and fail).
class CsvRow {
 public:
  explicit CsvRow(OutputFile& file) : file_(file) {}
  CsvRow& operator<<(double value) {
    Separate();
    AppendNumber(file_.text(), value);
    return *this;
  }
  CsvRow& operator<<(std::int64_t value) {
    Separate();
    char digits[24];
    file_.text().append(digits, std::to_chars(digits, digits + sizeof(digits), value).ptr);
    return *this;
  }
  CsvRow& operator<<(std::string_view text) {
    Separate();
    file_.text().append(text);
    return *this;
  }
  CsvRow& operator<<(const Vector3d& v) { return *this << v.x() << v.y() << v.z(); }
  /// w, x, y, z
  CsvRow& operator<<(const Quaterniond& q) { return *this << q.w() << q.x() << q.y() << q.z(); }
  /// an empty field when there is no value
  template <class T>
  CsvRow& operator<<(const std::optional<T>& value) {
    return value ? *this << *value : *this << std::string_view{};
  }
  void operator<<(EndOfRow) { file_.EndRow(); }

 private:
  void Separate() {
    if (!first_) file_.text() += ',';
    first_ = false;
  }

  OutputFile& file_;
  bool first_ = true;
};

}  // namespace piperun::scenarios
