#include "tools/piperun/progress_bar.h"

#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>

namespace piperun::tools {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;
constexpr int kWidth = 30;

}  // namespace

ProgressBar::ProgressBar(std::string label, bool enabled)
    : label_(std::move(label)), enabled_(enabled && ::isatty(STDERR_FILENO)), begin_(steady_clock::now()) {}

ProgressBar::~ProgressBar() {
  if (shown_) fmt::print(stderr, "\r\033[K");
}

void ProgressBar::Update(double fraction, const std::string& note) {
  if (!enabled_) return;
  const auto now = steady_clock::now();
  if (now - begin_ < milliseconds(2000) || now - last_ < milliseconds(100)) return;
  last_ = now;
  shown_ = true;
  const double done = std::clamp(fraction, 0.0, 1.0);
  const int filled = static_cast<int>(done * kWidth);
  fmt::print(stderr, "\r\033[K{} [{}{}] {:3.0f} % {}", label_,
             std::string(static_cast<std::size_t>(filled), '#'),
             std::string(static_cast<std::size_t>(kWidth - filled), '.'), 100 * done, note);
  std::fflush(stderr);
}

}  // namespace piperun::tools
