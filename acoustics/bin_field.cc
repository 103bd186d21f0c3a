#include "acoustics/bin_field.h"

#include <algorithm>

#include "acoustics/phase_row.h"
#include "base/check.h"

namespace piperun::acoustics {
namespace {

constexpr std::size_t kParts = StretchField::kParts;

std::vector<double> ListFrequencies_Hz(double bin_width_Hz, std::size_t first_bin, std::size_t end_bin) {
  std::vector<double> frequencies_Hz;
  for (std::size_t k = first_bin; k < end_bin; ++k) {
    for (std::size_t j = 0; j < kParts; ++j)
      frequencies_Hz.push_back((static_cast<double>(k) + StretchField::OffsetInBin(k, j)) * bin_width_Hz);
  }
  return frequencies_Hz;
}

}  // namespace

BinField::BinField(const AcousticNetwork& network, const std::vector<PipePlace>& sources,
                   const std::vector<std::vector<float>>& spectra, double bin_width_Hz,
                   const std::vector<int>& listening_pipes)
    : bin_width_Hz_(bin_width_Hz), bins_(spectra.empty() ? 0 : spectra[0].size()) {
  for (std::size_t first = 1; first < bins_;
       first *= 2) {  // an octave at a time: only what is kept takes room
    const std::size_t end = std::min(bins_, 2 * first);
    const NetworkField field(network, sources, ListFrequencies_Hz(bin_width_Hz, first, end));
    if (first == 1) Open(field, network, listening_pipes);
    Keep(field, network, first, end, spectra);
  }
}

void BinField::Open(const NetworkField& field, const AcousticNetwork& network,
                    const std::vector<int>& listening_pipes) {
  for (std::size_t i = 0; i < field.stretches(); ++i) {
    const NetworkField::Stretch& stretch = field.stretch(i);
    if (!std::binary_search(listening_pipes.begin(), listening_pipes.end(), stretch.pipe)) continue;
    const PipeWave& wave = network.pipes[static_cast<std::size_t>(stretch.pipe)].wave;
    Listening& listening = listening_.emplace_back(Listening{i, stretch, {}, {}});
    for (std::size_t k = 0; k < bins_; ++k) {
      listening.power_loss_1_m.push_back(static_cast<float>(2 * CalcLoss_Np_m(wave, stretch, k)));
    }
    const PhaseRow phases = CalcPhaseRow(wave, bin_width_Hz_, bins_);
    for (std::size_t source = 0; source < field.sources(); ++source)
      listening.fields.emplace_back(stretch.length_m, phases, bins_);
  }
}

void BinField::Keep(const NetworkField& field, const AcousticNetwork& network, std::size_t first_bin,
                    std::size_t end_bin, const std::vector<std::vector<float>>& spectra) {
  for (Listening& listening : listening_) {
    const PipeWave& wave = network.pipes[static_cast<std::size_t>(listening.stretch.pipe)].wave;
    for (std::size_t source = 0; source < listening.fields.size(); ++source) {
      for (std::size_t k = first_bin; k < end_bin; ++k) {
        std::complex<double> forward[kParts], backward[kParts];
        for (std::size_t j = 0; j < kParts; ++j) {
          const auto waves = field.FindWaves((k - first_bin) * kParts + j, source, listening.index);
          forward[j] = waves.forward, backward[j] = waves.backward;
        }
        listening.fields[source].Set(k, forward, backward, CalcLoss_Np_m(wave, listening.stretch, k),
                                     spectra[source][k]);
      }
    }
  }
}

double BinField::CalcLoss_Np_m(const PipeWave& wave, const NetworkField::Stretch& stretch,
                               std::size_t bin) const {
  return wave.Attenuation_Np_m(static_cast<double>(bin) * bin_width_Hz_) + stretch.local_loss_Np_m;
}

BinField::Listening& BinField::Find(const PipePlace& place) {
  const auto lies_before = [](const PipePlace& p, const Listening& listening) {
    return p.pipe < listening.stretch.pipe ||
           (p.pipe == listening.stretch.pipe && p.s_m < listening.stretch.begin_m);
  };
  auto after = std::upper_bound(listening_.begin(), listening_.end(), place, lies_before);
  const bool before_first = after == listening_.begin() || std::prev(after)->stretch.pipe != place.pipe;
  if (!before_first) --after;  // in front of a pipe's begin its first stretch goes on
  Demand(after != listening_.end() && after->stretch.pipe == place.pipe, "the listener is where it may be");
  return *after;
}

void BinField::Add(std::size_t source, const PipePlace& place, std::span<float> psd) {
  Listening& listening = Find(place);
  listening.fields[source].Add(place.s_m - listening.stretch.begin_m, listening.power_loss_1_m, psd);
}

}  // namespace piperun::acoustics
