#pragma once

#include "acoustics/jet.h"
#include "acoustics/source.h"

namespace piperun::acoustics {

/// The noise of a jet (acoustics/jet.h) and nothing else.
class JetSound : public LeakSound {
 public:
  explicit JetSound(const JetSpectrum& jet) : jet_(jet) {}
  double VolumeVelocityPsd(double f_Hz) const override { return jet_(f_Hz); }

 private:
  JetSpectrum jet_;
};

}  // namespace piperun::acoustics
