#include "acoustics/record_faults.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "base/check.h"
#include "base/number.h"

namespace piperun::acoustics {
namespace {

constexpr Range kTimes_s{.min = 0, .max = 1e6};

}  // namespace

void GainStep::Visit(ParamVisitor& v) {
  v.Number({.name = "t_s", .doc = "time of the record from which it holds", .required = true}, kTimes_s, t_s);
  v.Number({.name = "gain_dB", .doc = "over the nominal gain, not over the gain before", .required = true},
           Range::Between(-120, 120), gain_dB);
}

void DropOut::Visit(ParamVisitor& v) {
  v.Number({.name = "begin_s", .doc = "first lost sample, time of the record", .required = true}, kTimes_s,
           begin_s);
  v.Number({.name = "end_s", .doc = "first sample that is there again", .required = true}, kTimes_s, end_s);
}

void RecordFaultParams::Visit(ParamVisitor& v) {
  v.Items({.name = "gain_steps", .doc = "when the amplifier changes its gain, without saying so"},
          gain_steps);
  v.Items({.name = "drop_outs", .doc = "spans in which no sample is recorded: zeros stand there"}, drop_outs);
  v.Number({.name = "drop_outs_1_h", .doc = "how many more there are, at times drawn by seed and run"},
           Range::Between(0, 3600), drop_outs_1_h);
  v.Number({.name = "drop_out_s", .doc = "length of those"}, {.min = 0, .max = 1, .min_open = true},
           drop_out_s);
}

void RecordFaultParams::Check() const {
  for (std::size_t i = 1; i < gain_steps.size(); ++i) {
    if (gain_steps[i].t_s > gain_steps[i - 1].t_s) continue;
    throw InputError(FormatNumber(gain_steps[i].t_s) + " is not allowed; times must increase, above " +
                         FormatNumber(gain_steps[i - 1].t_s),
                     "faults.gain_steps[" + std::to_string(i) + "].t_s");
  }
  for (std::size_t i = 0; i < drop_outs.size(); ++i) {
    if (drop_outs[i].end_s > drop_outs[i].begin_s) continue;
    throw InputError(FormatNumber(drop_outs[i].end_s) + " is not allowed; it must be above begin_s, " +
                         FormatNumber(drop_outs[i].begin_s),
                     "faults.drop_outs[" + std::to_string(i) + "].end_s");
  }
}

RecordFaults::RecordFaults(const RecordFaultParams& params, Rate rate, const RandomStream& random)
    : rate_Hz_(std::llround(rate.Hz())),
      random_(random),
      drop_outs_per_s_(params.drop_outs_1_h / 3600),
      drop_out_s_(params.drop_out_s) {
  params.Check();
  for (const GainStep& step : params.gain_steps) {
    gains_.push_back({SampleAt(step.t_s), static_cast<float>(std::pow(10.0, step.gain_dB / 20))});
  }
  for (const DropOut& drop : params.drop_outs) {
    drops_.push_back({SampleAt(drop.begin_s), SampleAt(drop.end_s)});
  }
}

/// The first sample at or after a time.
std::int64_t RecordFaults::SampleAt(double t_s) const {
  return static_cast<std::int64_t>(std::ceil(t_s * static_cast<double>(rate_Hz_)));
}

void RecordFaults::Amplify(std::span<float> pressure_Pa) const {
  for (std::size_t g = 0; g < gains_.size(); ++g) {
    const auto size = static_cast<std::int64_t>(pressure_Pa.size());
    const std::int64_t until = g + 1 < gains_.size() ? gains_[g + 1].begin - next_sample_ : size;
    const std::int64_t end = std::min(until, size);
    for (std::int64_t i = std::max<std::int64_t>(gains_[g].begin - next_sample_, 0); i < end; ++i) {
      pressure_Pa[static_cast<std::size_t>(i)] *= gains_[g].factor;
    }
  }
}

void RecordFaults::Drop(std::span<std::int32_t> counts) {
  if (drops_.empty() && drop_outs_per_s_ == 0) {
    next_sample_ += static_cast<std::int64_t>(counts.size());
    return;
  }
  for (std::int32_t& count : counts) {
    if (!IsDropped(next_sample_++)) continue;
    count = 0;
    ++dropped_samples_;
  }
}

/// Asked for one sample after the other.
bool RecordFaults::IsDropped(std::int64_t sample) {
  if (sample % rate_Hz_ == 0) {
    drawn_before_ = drawn_;
    drawn_ = DrawDropOut(sample / rate_Hz_);
  }
  const auto holds = [sample](const Span& span) { return sample >= span.begin && sample < span.end; };
  return holds(drawn_) || holds(drawn_before_) || std::any_of(drops_.begin(), drops_.end(), holds);
}

RecordFaults::Span RecordFaults::DrawDropOut(std::int64_t second) const {
  const std::array<double, 4> u = random_.Uniforms(static_cast<std::uint64_t>(second), kSlot);
  if (u[0] >= drop_outs_per_s_) return {};
  const double begin_s = static_cast<double>(second) + u[1];
  return {SampleAt(begin_s), SampleAt(begin_s + drop_out_s_)};
}

}  // namespace piperun::acoustics
