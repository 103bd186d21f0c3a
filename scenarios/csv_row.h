#pragma once

#include <charconv>
#include <cstdint>
#include <string_view>

#include "base/number.h"
#include "base/pose.h"
#include "scenarios/output_file.h"

namespace piperun::scenarios {

/// One row of a CSV file: values separated by commas, doubles in shortest round-trip decimals. The row ends
/// when the object is destroyed.
class CsvRow {
 public:
  explicit CsvRow(OutputFile& file) : file_(file) {}
  ~CsvRow() { file_.EndRow(); }
  CsvRow(const CsvRow&) = delete;
  CsvRow& operator=(const CsvRow&) = delete;

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

 private:
  void Separate() {
    if (!first_) file_.text() += ',';
    first_ = false;
  }

  OutputFile& file_;
  bool first_ = true;
};

}  // namespace piperun::scenarios
