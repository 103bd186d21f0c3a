#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "base/water.h"

namespace piperun::acoustics {

/// Wall pressure spectra on equally spaced bins, interpolated between speeds 2 % apart. Rows are computed
/// when first asked for and kept until their place is needed; a row is a pure function of speed index and
/// bore, so what was asked before never shows in the result. Between two rows the power is linear in speed:
/// at most 0.03 dB from CalcWallPressurePsd, even in the steepest part of the spectrum.
class FlowNoiseTable {
 public:
  /// `gain[k]` multiplies bin k, which lies at k * bin_width_Hz.
  FlowNoiseTable(const WaterProperties& water, double face_radius_m, double bin_width_Hz,
                 std::vector<double> gain);

  /// Adds the spectrum at an eddy speed >= 0 to `psd` (Pa^2/Hz).
  void AddTo(std::span<float> psd, double speed_m_s, double bore_radius_m);

 private:
  struct Row {
    std::int64_t index = 0;
    double bore_radius_m = 0;  // 0: never filled
    std::vector<float> psd;
  };

  const Row& FindRow(std::int64_t index, double bore_radius_m);
  void Fill(Row& row) const;

  WaterProperties water_;
  double face_radius_m_;
  double bin_width_Hz_;
  std::vector<double> gain_;
  std::vector<Row> rows_;
};

}  // namespace piperun::acoustics
