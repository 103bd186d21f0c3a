#pragma once

#include <chrono>
#include <string>

namespace piperun::tools {

/// A progress bar on standard error: on a terminal only, and only once the work has taken two seconds.
class ProgressBar {
 public:
  ProgressBar(std::string label, bool enabled);
  ~ProgressBar();
  /// `fraction` from 0 to 1; `note` stands behind the bar.
  void Update(double fraction, const std::string& note);

 private:
  std::string label_;
  bool enabled_;
  bool shown_ = false;
  std::chrono::steady_clock::time_point begin_;
  std::chrono::steady_clock::time_point last_;
};

}  // namespace piperun::tools
