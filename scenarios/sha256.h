#pragma once

#include <filesystem>
#include <string>

namespace piperun::scenarios {

/// SHA-256 of a file's bytes, lower-case hexadecimal. Throws std::runtime_error when it cannot be read.
std::string Sha256OfFile(const std::filesystem::path& path);

}  // namespace piperun::scenarios
