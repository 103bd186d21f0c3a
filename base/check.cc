#include "base/check.h"

#include <cstdio>
#include <cstdlib>
#include <utility>

namespace piperun {
namespace {

std::string Join(const std::string& where, const std::string& key_path, const std::string& problem) {
  std::string text;
  if (!where.empty()) text += where + ": ";
  if (!key_path.empty()) text += key_path + ": ";
  return text + problem;
}

}  // namespace

InputError::InputError(const std::string& problem, std::string key_path, std::string where)
    : std::runtime_error(Join(where, key_path, problem)),
      problem_(problem),
      key_path_(std::move(key_path)),
      where_(std::move(where)) {}

void AbortWith(const char* message, const char* file, int line) {
  std::fprintf(stderr, "%s:%d: broken promise: %s\n", file, line, message);
  std::abort();
}

}  // namespace piperun
