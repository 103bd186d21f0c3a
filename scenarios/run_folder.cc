#include "scenarios/run_folder.h"

#include <fcntl.h>
#include <stdio.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <string>
#include <system_error>

#include "base/check.h"

namespace piperun::scenarios {
namespace fs = std::filesystem;
namespace {

fs::path MakeStagingFolder(const fs::path& final_path) {
  const fs::path parent = final_path.has_parent_path() ? final_path.parent_path() : fs::path(".");
  std::error_code error;
  fs::create_directories(parent, error);
  std::string name = (parent / ("." + final_path.filename().string() + ".partial-XXXXXX")).string();
  if (error || !::mkdtemp(name.data())) {
    throw InputError("cannot create a folder there (" +
                         std::generic_category().message(error ? error.value() : errno) +
                         "); choose another place",
                     "--out", final_path.string());
  }
  ::chmod(name.c_str(), 0755);
  return name;
}

}  // namespace

RunFolder::RunFolder(const fs::path& final_path, bool force) : final_path_(final_path), force_(force) {
  if (final_path_.filename().empty()) final_path_ = final_path_.parent_path();  // "out/"
  if (final_path_.empty()) throw InputError("an output folder needs a name", "--out");
  if (fs::exists(final_path_) && !force) {
    throw InputError("this folder exists already; choose another one, or replace it with --force", "--out",
                     final_path_.string());
  }
  if (fs::exists(final_path_) && !fs::exists(final_path_ / "run.json")) {
    throw InputError("this is not a run folder (it holds no run.json), so --force does not replace it",
                     "--out", final_path_.string());
  }
  staging_ = MakeStagingFolder(final_path_);
}

RunFolder::~RunFolder() {
  std::error_code ignored;
  if (!committed_) fs::remove_all(staging_, ignored);
}

fs::path RunFolder::Folder(const fs::path& relative) const {
  fs::create_directories(staging_ / relative);
  return staging_ / relative;
}

void RunFolder::Commit() {
  const auto rename_with = [this](unsigned int flags) {
    return ::renameat2(AT_FDCWD, staging_.c_str(), AT_FDCWD, final_path_.c_str(), flags) == 0;
  };
  if (rename_with(RENAME_NOREPLACE)) {
    committed_ = true;
    return;
  }
  if (errno != EEXIST)
    throw std::system_error(errno, std::generic_category(), "cannot write " + final_path_.string());
  if (!force_) {
    throw InputError("another run has taken this name meanwhile; choose another one", "--out",
                     final_path_.string());
  }
  // the old folder takes the temporary name, and goes with it
  if (!rename_with(RENAME_EXCHANGE)) {
    throw std::system_error(errno, std::generic_category(), "cannot replace " + final_path_.string());
  }
}

}  // namespace piperun::scenarios
