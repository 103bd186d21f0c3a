#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include "base/leak.h"
#include "base/params.h"

namespace piperun::acoustics {

/// The sound of one leak: one-sided power spectral density of its volume-velocity fluctuation. It belongs to
/// the hole; the pressure it makes follows from the pipe's impedance.
class LeakSound {
 public:
  virtual ~LeakSound() = default;
  /// S_q(f) in (m3/s)^2/Hz. Range f >= 0.
  virtual double VolumeVelocityPsd(double f_Hz) const = 0;
};

struct LeakSoundKind {
  std::string_view name;
  std::string_view doc;
  std::unique_ptr<Params> (*make_params)();
  /// A hole without outflow (no flow, or no pressure to drive it) is silent.
  std::unique_ptr<LeakSound> (*make)(const Params& params, double hole_diameter_m, const LeakState& state,
                                     double water_density_kg_m3);
};

/// Generated from acoustics/leaks/*.cc.
const std::vector<LeakSoundKind>& LeakSoundKinds();

}  // namespace piperun::acoustics
