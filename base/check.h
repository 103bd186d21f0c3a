#pragma once

#include <stdexcept>
#include <string>

namespace piperun {

/// Something the user wrote is wrong. Carries the key path of the value ("leaks[0].s_m"), so that whoever
/// knows the file can add file and line. The message says what is wrong, the value, the allowed range and
/// the remedy.
class InputError : public std::runtime_error {
 public:
  explicit InputError(const std::string& problem, std::string key_path = {}, std::string where = {});

  const std::string& problem() const { return problem_; }
  const std::string& key_path() const { return key_path_; }
  /// "file:line", or empty while nobody has said where.
  const std::string& where() const { return where_; }

 private:
  std::string problem_;
  std::string key_path_;
  std::string where_;
};

[[noreturn]] void AbortWith(const char* message, const char* file, int line);

/// Always-on check of our own promises: prints the message with its place and aborts. Never for user input.
inline void Demand(bool condition, const char* message, const char* file = __builtin_FILE(),
                   int line = __builtin_LINE()) {
  if (!condition) [[unlikely]]
    AbortWith(message, file, line);
}

}  // namespace piperun
