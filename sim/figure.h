#pragma once

#include <charconv>
#include <string>

namespace piperun::sim {

/// A figure for people to read: three significant digits.
inline std::string FormatFigure(double value) {
  char digits[32];
  const auto end = std::to_chars(digits, digits + sizeof(digits), value, std::chars_format::general, 3).ptr;
  return std::string(digits, end);
}

}  // namespace piperun::sim
