#include "sim/imu_sampling.h"

#include <algorithm>

#include "base/check.h"
#include "base/number.h"

namespace piperun::sim {
namespace {

// beyond those of the triads
constexpr std::uint64_t kJitterSlot = 64;
constexpr std::uint64_t kFateSlot = 65;

}  // namespace

void SamplingParams::Visit(ParamVisitor& v) {
  v.Number({"jitter_s", "Sampling instants scatter evenly by up to plus and minus this."},
           Range::NonNegative(), jitter_s);
  v.Flag({"jitter_stamped", "Stamps tell the instants as they were; false: as they should have been."},
         jitter_stamped);
  v.Number({"stamp_jitter_s", "Stamps scatter evenly by up to plus and minus this, the instants do not."},
           Range::NonNegative(), stamp_jitter_s);
  v.Number({"loss_probability", "Probability that samples begin to be lost, per sample."},
           Range::Between(0, 0.5), loss_probability);
  v.Integer({"loss_length", "How many samples in a row are then lost."}, 1, 1'000'000, loss_length);
  v.Number({"duplicate_probability", "Probability that the last sample is delivered again, per sample."},
           Range::Between(0, 0.5), duplicate_probability);
}

void SamplingParams::Check(Rate rate) const {
  const double most_s = 0.5 * rate.Period_s();
  if (jitter_s + stamp_jitter_s < most_s) return;
  throw InputError("jitter_s and stamp_jitter_s, " + FormatNumber(jitter_s + stamp_jitter_s) +
                       " s together, could make stamps fall; allowed: less than half the sampling period, " +
                       FormatNumber(most_s) + " s",
                   jitter_s >= stamp_jitter_s ? "jitter_s" : "stamp_jitter_s");
}

SamplingPlan::SamplingPlan(const SamplingParams& params, Rate rate, const RandomStream& random)
    : params_(params), rate_(rate), random_(random) {}

SamplingPlan::Scatter2 SamplingPlan::ScatterOf(std::int64_t k) const {
  if (params_.jitter_s == 0 && params_.stamp_jitter_s == 0) return {};
  const auto u = random_.Uniforms(static_cast<std::uint64_t>(k), kJitterSlot);
  const Duration instant = FromSeconds(params_.jitter_s * (2 * u[0] - 1));
  const Duration stamp = FromSeconds(params_.stamp_jitter_s * (2 * u[1] - 1));
  return {instant, params_.jitter_stamped ? instant + stamp : stamp};
}

TrueTime SamplingPlan::InstantOf(std::int64_t k) const {
  return k < 0 ? TrueTime{} : SampleTime(k + 1, rate_) + ScatterOf(k).instant;
}

TrueTime SamplingPlan::DueTimeOf(std::int64_t k) const {
  return SampleTime(k + 1, rate_) + ScatterOf(k).stamp;
}

Duration SamplingPlan::Scatter() const { return FromSeconds(params_.jitter_s + params_.stamp_jitter_s); }

bool SamplingPlan::BurstBeginsAt(std::int64_t k) const {
  return params_.loss_probability > 0 &&
         random_.Uniforms(static_cast<std::uint64_t>(k), kFateSlot)[0] < params_.loss_probability;
}

bool SamplingPlan::IsDuplicate(std::int64_t k) const {
  return k > 0 && params_.duplicate_probability > 0 &&
         random_.Uniforms(static_cast<std::uint64_t>(k), kFateSlot)[1] < params_.duplicate_probability;
}

}  // namespace piperun::sim
