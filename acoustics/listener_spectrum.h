#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "acoustics/flow_noise_table.h"
#include "acoustics/hydrophone.h"
#include "acoustics/scene.h"

namespace piperun::acoustics {

/// The spectrum a listener's record has at its place, tabulated on the bins of a frame: what does not change
/// is computed once, what changes from pipe to pipe when the listener comes into another one, what changes
/// with place and speed costs one exponential per bin and leak. Equals the pure functions of scene.h and
/// hydrophone.h within 0.03 dB. Where a leak has lost 200 dB or more it is silent, bin by bin; a leak that
/// has lost so much in all of them is left out.
class ListenerSpectrum {
 public:
  /// `bins` bins at k * bin_width_Hz, k = 0, 1, ...
  ListenerSpectrum(const AcousticScene& scene, const HydrophoneParams& params, double bin_width_Hz,
                   std::size_t bins);

  /// One-sided PSD per bin into `psd` (Pa^2/Hz, `bins` values); bin 0 is silent. Does not allocate.
  void Calc(const ListenerState& listener, std::span<float> psd);

 private:
  /// The way from a leak to an end of the listener's pipe.
  struct WayToEnd {
    double own_m = 0;               // through pipes with the wave of the listener's
    std::vector<float> other_loss;  // through the others: integral of 2 alpha ds, per bin
  };
  struct LeakRow {
    PathTree paths;
    std::vector<float> psd;  // at the hole, behind the input stage
    SoundingTimes times;
    std::array<WayToEnd, 3> ways;  // by WayIn; the direct one stays empty
  };

  std::size_t bins() const { return steady_.size(); }
  void TabulateLosses(double bin_width_Hz);
  void TabulateLeaks(const AcousticScene& scene, const std::vector<double>& high_pass, double bin_width_Hz);
  void EnterPipe(int pipe);
  void TabulateWay(const PathTree& paths, int node, WayToEnd& way);
  void AddLeak(const LeakRow& leak, const ListenerState& listener, std::span<float> psd) const;
  void AddRolling(double speed_m_s, std::span<float> psd) const;

  std::vector<AcousticPipe> pipes_;
  std::vector<std::size_t> wave_of_pipe_;           // pipes of the same make share a row of losses
  std::vector<std::vector<float>> power_loss_1_m_;  // per wave and bin: 2 alpha
  std::vector<double> path_m_;                      // scratch, per wave
  std::vector<LeakRow> leaks_;
  int pipe_ = -1;  // the one that the leaks' ways lead to
  std::vector<float> steady_;
  std::vector<float> rolling_;  // at 1 m/s; empty: none
  bool flow_noise_;
  FlowNoiseTable flow_noise_table_;
};

}  // namespace piperun::acoustics
