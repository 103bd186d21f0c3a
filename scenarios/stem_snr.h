#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/assemble.h"

namespace piperun::scenarios {

/// Signal to noise as it was recorded: the power of a leak's stem between 1 and 4 kHz (or as much of that as
/// the hydrophone records) over that of all stems that are no leaks (other sounds and backgrounds; no knocks,
/// no tones), both by Welch's method over half a second about an instant. Scatter: 0.15 dB.
class StemSnr {
 public:
  /// `folder` holds the stems of the channel (stem_recorder.h), which are complete.
  StemSnr(const Assembly& assembly, const HydrophoneChannel& channel, const std::filesystem::path& folder);

  /// Nothing where the record does not hold the half second or the band. Throws InputError for a stem that
  /// cannot be read.
  std::optional<double> Measure_dB(std::size_t leak, TrueTime t) const;

 private:
  double MeasureBand_Pa2(const std::string& stem, std::int64_t begin, std::int64_t samples) const;

  const HydrophoneChannel& channel_;
  std::filesystem::path folder_;
  std::vector<std::string> leaks_, noise_;  // names of stems
};

}  // namespace piperun::scenarios
