#pragma once

#include <cstddef>
#include <vector>

#include "acoustics/pipe_wave.h"

namespace piperun::acoustics {

/// How the phase between the two waves in a stretch turns with the way, on the bins k = 0, 1, ... of a frame
/// and around each: Re k(f) / pi in turns per metre. Where the wave has no dispersion that is `turns_1_m` k;
/// the last bin's speed is the measure, and what the others differ by is small.
struct PhaseRow {
  double turns_1_m = 0;                   ///< per bin
  std::vector<float> excess_turns_1_m{};  ///< of the first bins; behind them none
  std::vector<float> slopes{};            ///< of the same: turns from bin to bin, over turns_1_m
};

/// Bins lie at k * bin_width_Hz, two at least.
PhaseRow CalcPhaseRow(const PipeWave& wave, double bin_width_Hz, std::size_t bins);

}  // namespace piperun::acoustics
