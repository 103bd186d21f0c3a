#include "scenarios/stem_recorder.h"

#include <cmath>

namespace piperun::scenarios {

StemRecorder::StemRecorder(const acoustics::Hydrophone& hydrophone, double longest_s,
                           const std::filesystem::path& folder)
    : folder_(folder) {
  const double rate_Hz = hydrophone.rate().Hz();
  const acoustics::AudioFormat format{acoustics::AudioContainer::kFloatWav, std::llround(rate_Hz), 24};
  for (const std::string& name : hydrophone.StemNames())
    files_.emplace_back(folder / (name + ".wav"), format, std::llround(std::ceil(longest_s * rate_Hz)));
}

void StemRecorder::Write(const acoustics::Hydrophone& hydrophone) {
  for (std::size_t i = 0; i < files_.size(); ++i) files_[i].Write(hydrophone.stem_Pa(i));
}

void StemRecorder::Close() {
  for (acoustics::AudioWriter& file : files_) file.Close();
}

}  // namespace piperun::scenarios
