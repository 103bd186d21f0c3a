#pragma once

#include <filesystem>

namespace piperun::scenarios {

/// A folder that appears only complete: it is filled under a temporary name beside its final place, and
/// Commit() renames it. Without Commit() the destructor removes it.
class RunFolder {
 public:
  /// Throws InputError when `final_path` exists and `force` is not set, when it is no run folder, or
  /// when no folder can be created there.
  RunFolder(const std::filesystem::path& final_path, bool force);
  ~RunFolder();
  RunFolder(const RunFolder&) = delete;
  RunFolder& operator=(const RunFolder&) = delete;

  const std::filesystem::path& staging() const { return staging_; }
  /// Creates a sub-folder and returns its path.
  std::filesystem::path Folder(const std::filesystem::path& relative) const;
  /// Throws InputError when the name has been taken meanwhile and `force` is not set.
  void Commit();

 private:
  std::filesystem::path final_path_;
  std::filesystem::path staging_;
  bool force_;
  bool committed_ = false;
};

}  // namespace piperun::scenarios
