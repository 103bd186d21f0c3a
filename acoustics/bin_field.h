#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "acoustics/network_field.h"
#include "acoustics/stretch_field.h"

namespace piperun::acoustics {

/// What a network makes of its sources' spectra at a listener's place, on the bins of a frame: S times the
/// mean of |Z|^2 over each bin, Z of network_field.h. A frame tells no more: of echoes that come later than
/// it is long the combs are finer than a bin, and only their power is heard. Single precision.
class BinField {
 public:
  /// Bins at k * bin_width_Hz, k = 1, 2, ...; bin 0 is silent. `spectra[source][bin]` is S. A listener can be
  /// in `listening_pipes`, which rise.
  BinField(const AcousticNetwork& network, const std::vector<PipePlace>& sources,
           const std::vector<std::vector<float>>& spectra, double bin_width_Hz,
           const std::vector<int>& listening_pipes);

  /// Adds the spectrum of a source at a place in a listening pipe. Does not allocate.
  void Add(std::size_t source, const PipePlace& place, std::span<float> psd);

 private:
  struct Listening {
    std::size_t index;  // of the stretch in the field
    NetworkField::Stretch stretch;
    std::vector<float> power_loss_1_m;  // 2 alpha, per bin
    std::vector<StretchField> fields;   // by source
  };

  void Open(const NetworkField& field, const AcousticNetwork& network,
            const std::vector<int>& listening_pipes);
  void Keep(const NetworkField& field, const AcousticNetwork& network, std::size_t first_bin,
            std::size_t end_bin, const std::vector<std::vector<float>>& spectra);
  double CalcLoss_Np_m(const PipeWave& wave, const NetworkField::Stretch& stretch, std::size_t bin) const;
  Listening& Find(const PipePlace& place);

  double bin_width_Hz_;
  std::size_t bins_;
  std::vector<Listening> listening_;  // by pipe, then by begin
};

}  // namespace piperun::acoustics
