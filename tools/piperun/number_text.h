#pragma once

#include <string>

namespace piperun::tools {

/// "3 pipes", "1 pipe".
std::string Counted(std::size_t count, const char* what);
/// Hours, minutes and seconds: "1:02:03".
std::string Clock(double seconds);
/// So many digits behind the point, and no minus before zero.
std::string Fixed(double value, int digits);

}  // namespace piperun::tools
