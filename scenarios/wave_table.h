#pragma once

#include <map>
#include <vector>

#include "acoustics/pipe_wave.h"

namespace piperun::scenarios {

/// The waves of pipes, each cross-section told once: in soil a wave takes a good part of a millisecond.
class WaveTable {
 public:
  explicit WaveTable(const WaterProperties& water) : water_(water) {}
  /// Throws as acoustics::CalcPipeWave does.
  const acoustics::PipeWave& Find(const acoustics::PipeSection& section);

 private:
  WaterProperties water_;
  std::map<std::vector<double>, acoustics::PipeWave> waves_;  // by all numbers of the section
};

}  // namespace piperun::scenarios
