#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "acoustics/ambient.h"
#include "acoustics/pipe_wave.h"
#include "acoustics/source.h"
#include "base/params.h"
#include "base/random.h"
#include "base/time.h"
#include "base/water.h"

namespace piperun::acoustics {

/// What the hydrophone knows of the ball that carries it, at an instant.
struct ListenerState {
  double chainage_m = 0;
  double water_speed_m_s = 0;  ///< bulk velocity where the ball is
  double slip_speed_m_s = 0;   ///< |water speed - ball speed|
  double bore_radius_m = 0;
};

/// A leak where it sounds.
struct SoundingLeak {
  std::string id;
  double chainage_m = 0;
  std::shared_ptr<const LeakSound> sound;
};

/// The acoustic world of one run: the route's legs, its leaks, its background.
struct AcousticScene {
  std::vector<AcousticLeg> legs;
  std::vector<SoundingLeak> leaks;
  AmbientParams ambient;
  WaterProperties water;
};

/// A hydrophone with its converter.
struct HydrophoneParams : ParamsOf<HydrophoneParams> {
  double rate_Hz = 16000;
  std::int64_t block_samples = 1600;
  std::int64_t bits = 24;                 ///< 16 or 24
  double full_scale_Pa = 1000;            ///< pressure of the largest code
  double self_noise_dB_re_1uPa2_Hz = 42;  ///< at 1 kHz, flat above 100 Hz, 1/f below

  double scale_Pa() const;  ///< pascals per count
  void Visit(ParamVisitor& v) override;
};

/// Renders what a moving hydrophone records, block by block. Noise is drawn per frame of fixed length, keyed by
/// (stream, frame), so the samples do not depend on the size of the blocks asked for.
class Hydrophone {
 public:
  using ListenerAt = std::function<ListenerState(TrueTime)>;

  Hydrophone(const HydrophoneParams& params, AcousticScene scene, const RandomStream& random);
  ~Hydrophone();
  Hydrophone(Hydrophone&&) noexcept;

  Rate rate() const;
  /// How far beyond a block's last sample the listener is asked for.
  Duration lookahead() const;
  /// Next counts.size() samples; sample n is at SampleTime(n, rate). Clipped samples are counted.
  void Render(const ListenerAt& listener, std::span<std::int32_t> counts);
  std::int64_t clipped_samples() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

/// Ratio of leak power to the power of everything else at a listening place, 10 log10, over a band.
double CalcLeakSnr_dB(const AcousticScene& scene, std::size_t leak, const HydrophoneParams& params,
                      const ListenerState& listener, double f_low_Hz, double f_high_Hz);

}  // namespace piperun::acoustics
