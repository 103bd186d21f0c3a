#pragma once

#include <cstddef>
#include <memory>
#include <span>

namespace piperun::estimator {

/// Level of the noise in a band of a short frame, blind to tones (pumps, mains): lines stand in a few bins of
/// a spectrum, and the median over the bins passes them by. The frame x_0 .. x_(N-1) is weighted with Hann's
/// window,
///
///     P_k = 2 |sum w_n x_n exp(-2 pi i k n / N)|^2 / (f_s sum w_n^2)       one-sided density at f_k = k f_s
///     / N
///
/// and made flat by f^2.5 (noise in pipes falls by some 25 dB per decade). The values are exponentially
/// distributed, whose median is ln 2 of the mean, so the mean square in the band is
///
///     median_k(P_k f_k^2.5) / ln 2 * int f^-2.5 df          over the bins in the band
///
/// exact for noise that falls so. Units: Pa in, Pa^2 out. Does not allocate after construction.
class LineFreeLevels {
 public:
  LineFreeLevels(std::size_t samples, double rate_Hz);
  ~LineFreeLevels();
  LineFreeLevels(LineFreeLevels&&) noexcept;
  LineFreeLevels& operator=(LineFreeLevels&&) noexcept;

  /// True when at least one bin lies in the band.
  bool Resolves(double low_Hz, double high_Hz) const;
  /// Looks at a frame; a sample beyond the largest even number of them is left out.
  void Transform(std::span<const float> frame_Pa);
  /// Of the frame looked at last. Range: a band that is resolved.
  double CalcMeanSquare_Pa2(double low_Hz, double high_Hz);
  /// The same with all lines: the sum of P_k over the band times the bins' width.
  double CalcPower_Pa2(double low_Hz, double high_Hz) const;

 private:
  struct Plan;
  std::unique_ptr<Plan> plan_;
};

/// Scatter of such a level for Gaussian noise: a median of n independent exponential values has the relative
/// standard deviation 1 / (ln 2 sqrt(n)), and of a band B in a frame T there are B T / 1.6 (Hann's window
/// correlates the powers of neighbouring bins by 0.44, whether they lie above the median by 0.3).
double CalcLineFreeScatter_dB(double low_Hz, double high_Hz, double frame_s);

}  // namespace piperun::estimator
