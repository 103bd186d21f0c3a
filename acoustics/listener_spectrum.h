#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "acoustics/bin_field.h"
#include "acoustics/flow_noise_table.h"
#include "acoustics/higher_modes.h"
#include "acoustics/hydrophone.h"
#include "acoustics/scene.h"

namespace piperun::acoustics {

/// The spectrum a listener's record has at its place, on the bins of a frame: the mean over each bin of what
/// the pure functions of scene.h and hydrophone.h say. What does not change is computed once; what changes
/// with place and speed costs two exponentials and a cosine per bin and leak. A sum of stems: the leaks one
/// by one, distant noise, the eddies along the wall, the hydrophone itself.
class ListenerSpectrum {
 public:
  /// `bins` bins at k * bin_width_Hz, k = 0, 1, ...
  ListenerSpectrum(const AcousticScene& scene, const HydrophoneParams& params, double bin_width_Hz,
                   std::size_t bins);

  /// One-sided PSD per bin into `psd` (Pa^2/Hz, `bins` values); bin 0 is silent. Does not allocate.
  void Calc(const ListenerState& listener, std::span<float> psd);

  std::size_t sources() const { return leaks_.size(); }
  /// The sources, and behind them distant noise, flow (eddies and rolling) and the hydrophone itself.
  std::size_t stems() const { return sources() + 3; }
  std::string StemName(std::size_t stem) const;
  /// One of those that add up to Calc. Does not allocate.
  void CalcStem(std::size_t stem, const ListenerState& listener, std::span<float> psd);

 private:
  struct LeakRow {
    std::string id;
    PipePlace place;
    SoundingTimes times;
    double bore_radius_m = 0;
    std::vector<float> near;     // what the near field adds at the hole itself, behind the input stage
    std::vector<float> at_hole;  // of the plane wave, behind the input stage
    std::size_t modes = 0;       // which of mode_tables_
  };
  /// Of pipes that carry the same wave.
  struct ModeRow {
    PipeWave wave;
    HigherModeTable table;
  };

  void TabulateLeaks(const AcousticScene& scene, const std::vector<double>& high_pass, double bin_width_Hz);
  std::size_t FindOrMakeModes(const AcousticScene& scene, const PipeWave& wave, double bin_width_Hz);
  void AddRolling(const ListenerState& listener, std::span<float> psd) const;
  void AddEddies(const ListenerState& listener, std::span<float> psd);
  void AddLeak(std::size_t leak, const ListenerState& listener, std::span<float> psd);

  std::vector<LeakRow> leaks_;
  std::vector<ModeRow> mode_tables_;
  std::optional<BinField> field_;  // of the leaks, if any
  std::vector<float> distant_, self_, steady_;
  std::vector<float> rolling_;  // at 1 m/s; empty: none
  std::vector<float> scratch_;
  bool flow_noise_;
  FlowNoiseTable flow_noise_table_;
};

}  // namespace piperun::acoustics
