#include "scenarios/rest_check.h"

#include <algorithm>
#include <cmath>

#include "base/number.h"

namespace piperun::scenarios {
namespace {

constexpr double kStepsPerE = 20;
constexpr double kBlock_s = 1;
constexpr std::int64_t kShortestBlock = 16;
constexpr double kMostShake = 3;
constexpr double kMostJump = 12;
constexpr std::int64_t kFewestJumps = 20;  // whose median can be told
constexpr double kFastestBias_rad_s = 0.52;

std::string At(double time_s) { return FormatDigits(time_s, 6) + " s"; }

}  // namespace

void LogHistogram::Add(double value) {
  const double place = value > 0 ? kStepsPerE * std::log(value) + 2048 : 0;
  ++counts_[static_cast<std::size_t>(std::clamp(place, 0.0, 4095.0))];
  ++total_;
}

double LogHistogram::Median() const {
  std::int64_t below = 0;
  for (std::size_t i = 0; i < counts_.size(); ++i) {
    below += counts_[i];
    if (2 * below >= total_ && total_ > 0)
      return i == 0 ? 0 : std::exp((static_cast<double>(i) - 2047.5) / kStepsPerE);
  }
  return 0;
}

RestCheck::RestCheck(double period_s)
    : period_s_(period_s),
      block_(std::max(kShortestBlock, static_cast<std::int64_t>(std::llround(kBlock_s / period_s)))) {}

void RestCheck::Append(std::span<const double> values) {
  for (const double value : values) {
    if (in_block_ > 0) {
      const double step = value - last_;
      squared_differences_ += step * step;
      if (step != 0) smallest_step_ = std::min(smallest_step_, std::abs(step));
    }
    last_ = value;
    sum_ += value;
    ++samples_;
    if (++in_block_ == block_) EndBlock();
  }
}

void RestCheck::EndBlock() {
  const double n = static_cast<double>(in_block_), mean = sum_ / n;
  const double time_s = static_cast<double>(samples_) * period_s_;
  const double roughness = std::sqrt(squared_differences_ / (n - 1));
  roughness_.Add(roughness);
  if (roughness > roughest_) roughest_ = roughness, roughest_s_ = time_s;
  if (has_last_mean_) {
    const double jump = std::abs(mean - last_mean_);
    jumps_.Add(jump);
    if (jump > largest_jump_) largest_jump_ = jump, largest_jump_s_ = time_s;
  }
  mean_sum_ += mean;
  mean_squares_ += mean * mean;
  ++blocks_;
  last_mean_ = mean;
  has_last_mean_ = true;
  in_block_ = 0;
  sum_ = squared_differences_ = 0;
}

void RestCheck::StartSegment() {
  in_block_ = 0;
  sum_ = squared_differences_ = 0;
  has_last_mean_ = false;
}

RestFindings RestCheck::Findings() const {
  RestFindings findings;
  if (blocks_ == 0) return findings;
  const double n = static_cast<double>(blocks_);
  // a register that seldom changes has a median of nothing: its own step is the least that counts as noise
  const double step = std::isfinite(smallest_step_) ? smallest_step_ : 0;
  const double roughness = std::max(roughness_.Median(), step), jump = std::max(jumps_.Median(), 0.1 * step);
  findings.mean = mean_sum_ / n;
  findings.rms_of_means = std::sqrt(mean_squares_ / n);
  findings.shake_ratio = roughness > 0 ? roughest_ / roughness : 0;
  findings.shake_s = roughest_s_;
  findings.jump_ratio = jump > 0 && jumps_.total() >= kFewestJumps ? largest_jump_ / jump : 0;
  findings.jump_s = largest_jump_s_;
  return findings;
}

std::vector<std::string> JudgeRest(const RestFindings& findings, const std::string& group) {
  std::vector<std::string> said;
  if (group == "gyro" && findings.rms_of_means > kFastestBias_rad_s) {
    said.push_back("it turns: " + FormatDigits(findings.rms_of_means, 3) +
                   " rad/s, where rest reads at most " + FormatDigits(kFastestBias_rad_s, 2));
  }
  if (findings.shake_ratio > kMostShake) {
    said.push_back("it was shaken: " + FormatDigits(findings.shake_ratio, 3) +
                   " times the usual noise in the second before " + At(findings.shake_s));
  }
  if (findings.jump_ratio > kMostJump) {
    said.push_back("its mean jumped by " + FormatDigits(findings.jump_ratio, 3) +
                   " times the usual change in a second, before " + At(findings.jump_s));
  }
  return said;
}

}  // namespace piperun::scenarios
