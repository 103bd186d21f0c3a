#pragma once

#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "acoustics/pipe_wave.h"
#include "acoustics/scene.h"
#include "base/params.h"
#include "base/water.h"

namespace piperun::acoustics {

/// The pipe and the water where something sounds that is not a leak.
struct SoundSite {
  PipeWave wave;
  WaterProperties water;
  double flow_m3_s = 0;          ///< through the pipe, >= 0
  double gauge_pressure_Pa = 0;  ///< in the pipe
};

/// What a sound makes of its site. Any of the three may be missing.
struct SiteSound {
  std::shared_ptr<const LeakSound> noise{};  ///< Gaussian, as of a leak; null: none
  Role role = Role::kValve;                  ///< of the noise
  std::vector<Tone> tones{};
  double loss_length_m = 0;  ///< a stretch of pipe, centred on the site, with an extra loss
  double loss_Np_m = 0;      ///< at all frequencies
};

struct SoundKind {
  std::string_view name;
  std::string_view doc;
  std::unique_ptr<Params> (*make_params)();
  /// Throws InputError with the key of the parameter that the site does not allow.
  SiteSound (*make)(const Params& params, const SoundSite& site);
};

/// Generated from acoustics/sounds/*.cc.
const std::vector<SoundKind>& SoundKinds();

}  // namespace piperun::acoustics
