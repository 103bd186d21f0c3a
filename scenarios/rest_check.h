#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

namespace piperun::scenarios {

/// How many values fell where, on a logarithmic scale of 20 steps per factor e: medians in bounded memory.
class LogHistogram {
 public:
  void Add(double value);
  /// Within 2.5 %; 0 for an empty one.
  double Median() const;
  std::int64_t total() const { return total_; }

 private:
  std::array<std::int64_t, 4096> counts_{};
  std::int64_t total_ = 0;
};

/// What speaks against rest in one channel; times count from the record's first sample, gaps left out.
struct RestFindings {
  double mean = 0;
  double rms_of_means = 0;  ///< root mean square of the blocks' means
  double shake_ratio = 0;   ///< roughest block over the median: standard deviations of sample differences
  double shake_s = 0;
  /// Largest change of the mean from block to block, over the median change; 0 where those are few.
  double jump_ratio = 0;
  double jump_s = 0;
};

/// Watches one channel in blocks of about a second (16 samples or more).
class RestCheck {
 public:
  explicit RestCheck(double period_s);
  void Append(std::span<const double> values);
  /// The block under way is dropped.
  void StartSegment();
  RestFindings Findings() const;

 private:
  void EndBlock();

  double period_s_;
  std::int64_t block_;
  std::int64_t blocks_ = 0, samples_ = 0, in_block_ = 0;
  double sum_ = 0, squared_differences_ = 0, last_ = 0, last_mean_ = 0;
  bool has_last_mean_ = false;
  double mean_sum_ = 0, mean_squares_ = 0;
  double roughest_ = 0, roughest_s_ = 0, largest_jump_ = 0, largest_jump_s_ = 0;
  double smallest_step_ = std::numeric_limits<double>::infinity();
  LogHistogram roughness_, jumps_;
};

/// Sentences about a channel that did not rest; empty when it did. A resting sensor's blocks of 100 samples
/// are 3 times as rough as the median with a probability below 1e-100, whatever noise of IEEE Std 952, as
/// differences of samples forget; changes of block means are Gaussian, 12 medians of them 8 standard
/// deviations. A gyroscope that reads more than 0.52 rad/s (30 deg/s) turns: data sheets allow biases of up
/// to 25 deg/s (L3GD20H).
std::vector<std::string> JudgeRest(const RestFindings& findings, const std::string& group);

}  // namespace piperun::scenarios
