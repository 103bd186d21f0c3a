#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "acoustics/impact.h"
#include "acoustics/record_faults.h"
#include "acoustics/scene.h"
#include "base/params.h"
#include "base/random.h"
#include "base/time.h"

namespace piperun::acoustics {

/// A hydrophone with its preamplifier and converter.
struct HydrophoneParams : ParamsOf<HydrophoneParams> {
  double rate_Hz = 16000;
  std::int64_t block_samples = 1600;
  std::int64_t bits = 24;                 ///< 16 or 24
  double full_scale_Pa = 1000;            ///< pressure of the largest code
  double self_noise_dB_re_1uPa2_Hz = 42;  ///< at 1 kHz, flat above 100 Hz, 1/f below
  double high_pass_Hz = 10;               ///< -3 dB corner of the first-order input stage
  double face_radius_m = 0.005;           ///< of the sensitive face
  bool stems = false;                     ///< keep what each source contributes
  RecordFaultParams faults{};

  /// 2^(bits-1) - 1. Codes run from minus to plus this, in the low bits of an int32.
  std::int64_t largest_code() const;
  /// Pascals per count: full_scale_Pa / largest_code(); pressure = counts * scale_Pa().
  double scale_Pa() const;
  void Visit(ParamVisitor& v) override;
  /// Throws InputError for what the ranges in Visit cannot say: 16 or 24 bits, a rate of whole hertz (as
  /// audio files have it) within its range.
  void Check() const;
};

/// |H|^2 = f^2 / (f^2 + f_c^2) of the input stage, through which all sound in the water passes.
double CalcHighPassGain(const HydrophoneParams& params, double f_Hz);

/// Noise of sensor and preamplifier after the input stage, one-sided, in Pa^2/Hz. Range f > 0.
double CalcSelfNoisePsd(const HydrophoneParams& params, double f_Hz);

/// Rounding noise of the converter, scale^2 / (6 rate), one-sided, in Pa^2/Hz.
double CalcConverterNoisePsd(const HydrophoneParams& params);

/// Renders what a moving hydrophone records, block by block, level-exact in pascals: leaks as the listener
/// nears and leaves them, background, self noise, converter, clipping.
///
/// Independent Gaussian sources at one hydrophone are one source with the summed spectrum. It is drawn in
/// frames of a fixed length (the power of two nearest to 64 ms: 1024 samples at 16 kHz) with the spectrum of
/// the listener's place at the frame's centre, windowed with the root of a Hann window and added up with half
/// a frame's overlap. In between the power changes along a raised cosine. At 1 m/s the ball moves 32 mm
/// from frame to frame, 0.3 dB on a slope of 10 dB/m. Bins lie 16 Hz apart; DC and the Nyquist bin are
/// silent. Correlations longer than a frame (echoes, tones) cannot be made this way.
///
/// Knocks on the ball (acoustics/impact.h) and tones (acoustics/tones.h) are added before the converter. A
/// record without any is the same as if they did not exist. Gain steps and drop-outs come last
/// (acoustics/record_faults.h).
///
/// Stems tell the sources apart again (acoustics/stem_frames.h): in pascals behind the input stage, before
/// what is wrong with the record and before the converter. They add up to what the converter is given, and
/// nothing in the record changes when they are kept.
///
/// Random numbers are keyed by (stream, frame, bin): the samples do not depend on the size of the blocks. Of
/// the stream, samples are frames and slots 0 to N/8 bins; slots from ImpactSound::kFirstSlot on are the
/// knocks'. Rendering does not allocate.
class Hydrophone {
 public:
  using ListenerAt = std::function<ListenerState(TrueTime)>;

  /// Parameters within the ranges of their Visit. Throws as HydrophoneParams::Check and
  /// ImpactParams::Check do.
  Hydrophone(const HydrophoneParams& params, const AcousticScene& scene, const RandomStream& random);
  ~Hydrophone();
  Hydrophone(Hydrophone&&) noexcept;

  Rate rate() const;
  /// How far beyond a block's last sample the listener is asked for at most: half a frame.
  Duration lookahead() const;
  /// A knock on the ball, to be told before Render reaches the sample at or after its beginning; aborts when
  /// it comes too late.
  void Add(const Knock& knock);
  /// Next counts.size() samples; sample n is at SampleTime(n, rate). The listener is asked for once per half
  /// frame, at increasing times from zero on; where its state is not finite (a run that has gone wrong) the
  /// frame is silent. Clipped samples are counted.
  void Render(const ListenerAt& listener, std::span<std::int32_t> counts);
  std::int64_t clipped_samples() const;
  std::int64_t dropped_samples() const;

  /// Of stems, if they are kept: source_ID per leak or sound, background_distant, background_flow (rolling,
  /// too), background_self, knocks, tones.
  std::vector<std::string> StemNames() const;
  /// What a stem contributes to the samples of the last Render.
  std::span<const float> stem_Pa(std::size_t stem) const;

  /// Mean square in pascals of every localised source of the scene, in its order, and behind them of all
  /// other noise (background, self noise, rounding; no knocks, no tones) at a listening place, over a band: a
  /// frame's bins between its ends. `band` holds a number per source and one more. Throws InputError unless
  /// 0 < f_low_Hz < f_high_Hz <= rate/2 with a bin between. Does not allocate.
  void CalcBandPower(const ListenerState& listener, double f_low_Hz, double f_high_Hz,
                     std::span<double> band_Pa2);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

/// Ratio of one leak's power to the power of everything that is not a leak (background, self noise, rounding)
/// in the record, at a listening place, 10 log10, over a band. Minus infinity for a silent leak and where no
/// pipe leads. Throws
/// InputError unless 0 < f_low_Hz < f_high_Hz <= rate/2.
double CalcLeakSnr_dB(const AcousticScene& scene, std::size_t leak, const HydrophoneParams& params,
                      const ListenerState& listener, double f_low_Hz, double f_high_Hz);

}  // namespace piperun::acoustics
