#pragma once

#include <charconv>
#include <optional>
#include <string>
#include <string_view>

namespace piperun {

/// Shortest decimal text that reads back as exactly this value (at most 17 significant digits).
std::string FormatNumber(double value);

/// For people to read: `digits` significant ones, as printf's %g; `decimals` behind the point, as its %f.
std::string FormatDigits(double value, int digits);
std::string FormatFixed(double value, int decimals);

/// The double written in `text`, or nothing when `text` is not a number from end to end. Accepts a leading
/// '+', decimal and scientific notation; refuses hexadecimal, "inf" and "nan" in any spelling.
std::optional<double> ParseNumber(std::string_view text);

/// Appends the shortest round-trip decimal of `value` without allocating beyond `out`'s own growth.
inline void AppendNumber(std::string& out, double value) {
  char digits[32];
  const auto result = std::to_chars(digits, digits + sizeof(digits), value);
  out.append(digits, result.ptr);
}

}  // namespace piperun
