#include "base/params.h"

#include <cmath>

#include "base/number.h"

namespace piperun {

std::string Range::Text() const {
  const bool low = std::isfinite(min), high = std::isfinite(max);
  if (!low && !high) return "any number";
  if (low && high) {
    return std::string(min_open ? "(" : "[") + FormatNumber(min) + ", " + FormatNumber(max) + (max_open ? ")" : "]");
  }
  if (low) return std::string(min_open ? "> " : ">= ") + FormatNumber(min);
  return std::string(max_open ? "< " : "<= ") + FormatNumber(max);
}

void ParamVisitor::Matrix(const ParamInfo& info, const Range& range, Matrix3d& value) {
  Eigen::Matrix<double, 3, 3, Eigen::RowMajor> rows = value;
  Array(info, range, std::span<double>(rows.data(), 9));
  value = rows;
}

}  // namespace piperun
