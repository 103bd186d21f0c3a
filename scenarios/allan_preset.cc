// A fitted record as a preset of sensors.
#include <array>
#include <cmath>

#include "base/check.h"
#include "base/number.h"
#include "scenarios/allan_report.h"
#include "sim/imu_error_params.h"

namespace piperun::scenarios {
namespace {

using estimator::Index;
using estimator::NoiseTerm;

struct PresetTriad {
  const char* group;
  const sim::TriadFieldNames& keys;
};
const PresetTriad kTriads[] = {{"gyro", sim::kGyroFields}, {"accel", sim::kAccelFields}};

/// The axes of a group whose Gauss-Markov process is identifiable with its time: root mean square of the
/// first, geometric mean of the second. Nothing when there is none, as when it was not asked for.
struct MarkovValue {
  double sd = 0;
  double time_s = 0;
};
std::optional<MarkovValue> CombineMarkov(const AllanAnalysis& analysis, const std::string& group) {
  double squares = 0, log_times = 0;
  int axes = 0;
  for (const AllanChannel& channel : analysis.channels) {
    const auto& sd = channel.fit.terms[Index(NoiseTerm::kGaussMarkov)];
    const auto& time_s = channel.fit.gauss_markov_time_s;
    if (channel.group != group || !sd.identifiable || !time_s.identifiable) continue;
    squares += sd.value * sd.value;
    log_times += std::log(time_s.value);
    ++axes;
  }
  if (axes == 0) return std::nullopt;
  return MarkovValue{std::sqrt(squares / axes), std::exp(log_times / axes)};
}

/// "key: value", or a comment with the bound. A ramp is the same on all three axes.
std::string TermLine(const AllanAnalysis& analysis, const std::string& group, std::string_view key,
                     NoiseTerm term) {
  const auto value = CombineAxes(analysis, group, term);
  const std::string name(key);
  if (!value) {
    return "    # " + name + ": not identifiable from this record, below " +
           FormatDigits(BoundAxes(analysis, group, term), 3) + "\n";
  }
  const std::string text = FormatDigits(*value, 6);
  if (term != NoiseTerm::kRamp) return "    " + name + ": " + text + "\n";
  return "    " + name + ": [" + text + ", " + text + ", " + text +
         "]  # an Allan deviation does not tell the sign\n";
}

std::string TriadSection(const AllanAnalysis& analysis, const PresetTriad& triad) {
  const std::array<std::pair<std::string_view, NoiseTerm>, 5> lines{{
      {triad.keys.quantisation, NoiseTerm::kQuantisation},
      {triad.keys.noise, NoiseTerm::kWhite},
      {triad.keys.bias_instability, NoiseTerm::kFlicker},
      {triad.keys.rate_random_walk, NoiseTerm::kRateRandomWalk},
      {triad.keys.rate_ramp, NoiseTerm::kRamp},
  }};
  std::string text;
  const auto markov = CombineMarkov(analysis, triad.group);
  bool any = markov.has_value();
  for (const auto& [key, term] : lines) {
    any |= CombineAxes(analysis, triad.group, term).has_value();
    text += TermLine(analysis, triad.group, key, term);
  }
  if (markov) {
    text += "    " + std::string(triad.keys.gauss_markov_sd) + ": " + FormatDigits(markov->sd, 6) +
            "\n    gauss_markov_time_s: " + FormatDigits(markov->time_s, 6) + "\n";
  }
  return "  " + std::string(triad.group) + (any ? ":\n" : ": {}\n") + text;
}

bool HasGroup(const AllanAnalysis& analysis, const char* group) {
  for (const AllanChannel& channel : analysis.channels) {
    if (channel.group == group) return true;
  }
  return false;
}

}  // namespace

std::string WriteSensorPreset(const AllanAnalysis& analysis) {
  std::string sections;
  for (const PresetTriad& triad : kTriads) {
    if (HasGroup(analysis, triad.group)) sections += TriadSection(analysis, triad);
  }
  if (sections.empty())
    throw InputError("a sensor of kind imu wants gyro or accel; the record has neither", "--preset");
  return "# Fitted by piperun allan: root mean square over the axes. A record at rest says nothing of scale, "
         "range,\n"
         "# bandwidth and misalignment, and the rounding of an output register is part of its white noise: "
         "add them\n"
         "# from the data sheet. In a scenario: sensors: {imu0: {kind: imu, preset: THIS_FILE}}\n"
         "name: fitted\ndescription: Noise fitted to a record at rest\nimu:\n  rate_Hz: " +
         FormatDigits(1 / analysis.timing.period_s, 7) + "\n" + sections;
}

}  // namespace piperun::scenarios
