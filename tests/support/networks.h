#pragma once

#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>

#include "sim/network/inp_reader.h"

namespace piperun::testing {

/// The repository's root, found upwards from this very file, or, where the compiler was given a relative path
/// to it (ccache does that), from the working directory.
inline std::filesystem::path RepositoryRoot() {
  namespace fs = std::filesystem;
  const fs::path file = __FILE__;
  fs::path folder = file.is_absolute() ? file.parent_path() : fs::current_path();
  while (!fs::exists(folder / "assets/networks") && folder.has_relative_path()) folder = folder.parent_path();
  return folder;
}

inline std::string ReadText(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw std::runtime_error("cannot read " + path.string());
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
