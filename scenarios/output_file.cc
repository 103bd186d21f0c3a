#include "scenarios/output_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <iterator>
#include <system_error>

#include "base/check.h"

namespace piperun::scenarios {
namespace {

[[noreturn]] void ThrowSystemError(const std::filesystem::path& path) {
  throw std::system_error(errno, std::generic_category(), "cannot write " + path.string());
}

}  // namespace

OutputFile::OutputFile(const std::filesystem::path& path)
    : path_(path), descriptor_(::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644)) {
  if (descriptor_ < 0) ThrowSystemError(path_);
  buffer_.reserve(kFlushAt + 4096);
}

OutputFile::~OutputFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void OutputFile::Flush() {
  std::string_view rest = buffer_;
  while (!rest.empty()) {
    const ssize_t written = ::write(descriptor_, rest.data(), rest.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) ThrowSystemError(path_);
    rest.remove_prefix(static_cast<std::size_t>(written));
  }
  buffer_.clear();
}

void OutputFile::Close() {
  Flush();
  const int closed = ::close(descriptor_);
  descriptor_ = -1;
  if (closed != 0) ThrowSystemError(path_);
}

void WriteTextFile(const std::filesystem::path& path, std::string_view text) {
  OutputFile file(path);
  file.Append(text);
  file.Close();
}

std::string ReadTextFile(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw InputError("cannot read this file", "", path.string());
  std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  if (file.bad()) throw InputError("cannot read this file", "", path.string());
  return text;
}

}  // namespace piperun::scenarios
