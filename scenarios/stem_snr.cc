#include "scenarios/stem_snr.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "acoustics/sound_file.h"
#include "estimator/cross_spectrum.h"
#include "scenarios/passage_log.h"

namespace piperun::scenarios {
namespace {

constexpr double kWindow_s = 0.5, kSegment_s = 0.064;

}  // namespace

StemSnr::StemSnr(const Assembly& assembly, const HydrophoneChannel& channel,
                 const std::filesystem::path& folder)
    : channel_(channel), folder_(folder) {
  const std::vector<acoustics::SoundingLeak>& sources = assembly.scene.leaks;
  const std::vector<std::string> names = channel.hydrophone().StemNames();  // the sources first, in order
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i < sources.size()) {
      (sources[i].role == acoustics::Role::kLeak ? leaks_ : noise_).push_back(names[i]);
    } else if (names[i].starts_with("background_")) {
      noise_.push_back(names[i]);
    }
  }
}

std::optional<double> StemSnr::Measure_dB(std::size_t leak, TrueTime t) const {
  const double rate_Hz = channel_.hydrophone().rate().Hz();
  const auto samples = static_cast<std::int64_t>(kWindow_s * rate_Hz);
  const std::int64_t begin = channel_.FindSample(t) - samples / 2;
  const std::int64_t frames = acoustics::SoundFile(folder_ / (leaks_[leak] + ".wav")).frames();
  if (begin < 0 || begin + samples > frames || rate_Hz <= 2 * kPassageLow_Hz) return std::nullopt;
  double noise_Pa2 = 0;
  for (const std::string& stem : noise_) noise_Pa2 += MeasureBand_Pa2(stem, begin, samples);
  return 10 * std::log10(MeasureBand_Pa2(leaks_[leak], begin, samples) / noise_Pa2);
}

double StemSnr::MeasureBand_Pa2(const std::string& stem, std::int64_t begin, std::int64_t samples) const {
  acoustics::SoundFile file(folder_ / (stem + ".wav"));
  file.SeekTo(begin);
  std::vector<double> read_Pa(static_cast<std::size_t>(samples));
  file.Read(read_Pa);
  const std::vector<float> record_Pa(read_Pa.begin(), read_Pa.end());
  const std::size_t segment = std::bit_floor(static_cast<std::size_t>(kSegment_s * file.rate_Hz()));
  const auto spectrum = estimator::CalcCrossSpectra(record_Pa, record_Pa, file.rate_Hz(), segment);
  double sum = 0;
  for (std::size_t k = 1; k < spectrum.bins(); ++k) {
    const double f_Hz = static_cast<double>(k) * spectrum.bin_width_Hz;
    if (f_Hz >= kPassageLow_Hz && f_Hz < kPassageHigh_Hz) sum += spectrum.aa[k] * spectrum.bin_width_Hz;
  }
  return sum;
}

}  // namespace piperun::scenarios
