#pragma once

#include <array>

#include "base/random.h"

namespace piperun::scenarios::detectors {

/// A stationary Gaussian process along the way, of standard deviation sigma and covariance
/// sigma^2 exp(-x^2 / (2 l^2)): the sum of 32 cosines of equal amplitude whose wavenumbers are normal with
/// standard deviation 1/l (random Fourier features, Rahimi & Recht, NIPS 2007). A pure function of place.
class SlowDrift {
 public:
  SlowDrift(double sd_dB, double length_m, const RandomStream& random);
  double Eval_dB(double chainage_m) const;

 private:
  struct Wave {
    double wavenumber_1_m = 0, phase_rad = 0;
  };
  double amplitude_dB_;
  std::array<Wave, 32> waves_;
};

}  // namespace piperun::scenarios::detectors
