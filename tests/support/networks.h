#pragma once

#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>

#include "sim/network/inp_reader.h"

namespace piperun::testing {

/// The repository's root, found upwards from this very file.
inline std::filesystem::path RepositoryRoot() {
  return std::filesystem::path(__FILE__).parent_path().parent_path().parent_path();
}

inline std::string ReadText(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  std::stringstream text;
  text << stream.rdbuf();
  return text.str();
}

/// One of our own networks.
inline sim::HydraulicModel ReadOwnNetwork(const std::string& name) {
  return sim::ReadInp(ReadText(RepositoryRoot() / "assets/networks" / name), name);
}

/// A public network, where it is at hand (see ../shared/networks/README.md beside the repository).
inline std::optional<sim::HydraulicModel> FindPublicNetwork(const std::string& name) {
  const auto path = RepositoryRoot().parent_path() / "shared/networks" / name;
  if (!std::filesystem::exists(path)) return std::nullopt;
  return sim::ReadInp(ReadText(path), name);
}

}  // namespace piperun::testing
