#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "acoustics/audio_file.h"
#include "acoustics/hydrophone.h"

namespace piperun::scenarios {

/// Writes a hydrophone's stems, a file each: truth/stems/CHANNEL/STEM.wav, single-precision pascals, sample
/// by sample beside the record.
class StemRecorder {
 public:
  /// `longest_s`: the run cannot be longer.
  StemRecorder(const acoustics::Hydrophone& hydrophone, double longest_s,
               const std::filesystem::path& folder);

  /// What the hydrophone rendered last.
  void Write(const acoustics::Hydrophone& hydrophone);
  void Close();
  const std::filesystem::path& folder() const { return folder_; }

 private:
  std::filesystem::path folder_;
  std::vector<acoustics::AudioWriter> files_;
};

}  // namespace piperun::scenarios
