#pragma once

#include <string>

namespace piperun::scenarios {

/// Every key of the scenario file, with default, allowed range and meaning, as Markdown; made from the same
/// Visit functions that read the file.
std::string WriteReference();

}  // namespace piperun::scenarios
