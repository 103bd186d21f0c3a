#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace piperun::scenarios {

/// A file being written, buffered. Every failure of the disk is an exception (std::system_error with the
/// path), never a short file.
class OutputFile {
 public:
  explicit OutputFile(const std::filesystem::path& path);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  /// The buffer to append to; it goes to disk when it is long enough and EndRow() is called.
  std::string& text() { return buffer_; }
  void EndRow() {
    buffer_ += '\n';
    if (buffer_.size() >= kFlushAt) Flush();
  }
  void Append(std::string_view text) {
    buffer_ += text;
    if (buffer_.size() >= kFlushAt) Flush();
  }
  /// Writes what is left and closes; call it, the destructor cannot report.
  void Close();

 private:
  static constexpr std::size_t kFlushAt = 1 << 16;
  void Flush();

  std::filesystem::path path_;
  int descriptor_;
  std::string buffer_;
};

/// Writes a whole small file.
void WriteTextFile(const std::filesystem::path& path, std::string_view text);
/// Reads a whole small file; throws InputError naming it when it cannot be read.
std::string ReadTextFile(const std::filesystem::path& path);

}  // namespace piperun::scenarios
