#pragma once

#include <cstdint>

#include "base/params.h"
#include "base/random.h"
#include "base/time.h"

namespace piperun::sim {

/// When an IMU's samples are taken, what their stamps say of it, and which of them arrive.
struct SamplingParams {
  double jitter_s = 0;
  bool jitter_stamped = true;
  double stamp_jitter_s = 0;
  double loss_probability = 0;
  std::int64_t loss_length = 1;
  double duplicate_probability = 0;

  void Visit(ParamVisitor& v);
  /// Throws InputError when neighbouring stamps or instants could change places at this rate.
  void Check(Rate rate) const;
};

/// The instants and the fate of samples 0, 1, .. of one channel: pure functions of the sample's number. With
/// u uniform on (-1, 1), drawn anew for every sample:
///   sampling instant  a_k = t_k + jitter u_1,  t_k = (k + 1) / rate
///   due and stamped   d_k = t_k + (jitter u_1 where it is stamped) + stamp_jitter u_2
/// so sample k covers (a_{k-1}, a_k], and nothing between two samples is left out. a_{-1} = 0.
class SamplingPlan {
 public:
  /// Uses the stream's slots kSamplingSlots and up.
  SamplingPlan(const SamplingParams& params, Rate rate, const RandomStream& random);

  Rate rate() const { return rate_; }
  TrueTime InstantOf(std::int64_t k) const;
  TrueTime DueTimeOf(std::int64_t k) const;
  /// How far an instant can lie behind its due time, or a stamp beside its grid.
  Duration Scatter() const;
  /// A burst of losses begins with each sample with its probability and lasts `loss_length` samples.
  bool BurstBeginsAt(std::int64_t k) const;
  std::int64_t loss_length() const { return params_.loss_length; }
  /// The sensor delivers its last sample once more instead of this one.
  bool IsDuplicate(std::int64_t k) const;

 private:
  struct Scatter2 {
    Duration instant{0};
    Duration stamp{0};
  };
  Scatter2 ScatterOf(std::int64_t k) const;

  SamplingParams params_;
  Rate rate_;
  RandomStream random_;
};

}  // namespace piperun::sim
