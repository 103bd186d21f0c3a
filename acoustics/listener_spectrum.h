#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "acoustics/flow_noise_table.h"
#include "acoustics/hydrophone.h"
#include "acoustics/scene.h"

namespace piperun::acoustics {

/// The spectrum a listener's record has at its place, tabulated on the bins of a frame: what does not change
/// is computed once, what changes with place and speed costs one exponential per bin and leak. Equals the
/// pure functions of scene.h and hydrophone.h within 0.03 dB.
class ListenerSpectrum {
 public:
  /// `bins` bins at k * bin_width_Hz, k = 0, 1, ...
  ListenerSpectrum(const AcousticScene& scene, const HydrophoneParams& params, double bin_width_Hz,
                   std::size_t bins);

  /// One-sided PSD per bin into `psd` (Pa^2/Hz, `bins` values); bin 0 is silent. Does not allocate.
  void Calc(const ListenerState& listener, std::span<float> psd);

 private:
  struct LeakRow {
    double chainage_m;
    std::vector<float> psd;  // at the hole, behind the input stage
  };

  std::size_t bins() const { return steady_.size(); }
  void TabulateLosses(const AcousticScene& scene, double bin_width_Hz);
  void TabulateLeaks(const AcousticScene& scene, const std::vector<double>& high_pass, double bin_width_Hz);
  void CalcPowerLoss(double from_m, double to_m);
  void AddLeak(const LeakRow& leak, double chainage_m, std::span<float> psd);

  std::vector<AcousticLeg> legs_;
  std::vector<std::size_t> wave_of_leg_;            // legs of the same pipe share a row of losses
  std::vector<std::vector<float>> power_loss_1_m_;  // per wave and bin: 2 alpha
  std::vector<double> path_m_;                      // scratch, per wave
  std::vector<float> power_loss_;                   // scratch, per bin
  std::vector<LeakRow> leaks_;
  std::vector<float> steady_;
  bool flow_noise_;
  FlowNoiseTable flow_noise_table_;
};

}  // namespace piperun::acoustics
