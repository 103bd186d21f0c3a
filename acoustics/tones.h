#pragma once

#include <complex>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "acoustics/network_field.h"
#include "acoustics/sounding_times.h"
#include "base/time.h"

namespace piperun::acoustics {

struct AcousticScene;
struct ListenerState;

/// A steady line of a machine: volume velocity q(t) = q cos(2 pi f t + phi), t the time of the record.
struct Tone {
  double f_Hz = 0;
  double volume_velocity_m3_s = 0;  ///< peak value q
  double phase_rad = 0;             ///< phi
};

/// What all lines of a machine have in common.
struct HarmonicSeries {
  double first_Hz = 0;
  int lines = 1;
  double level_dB_re_1uPa = 0;  ///< rms of the first line, in the water beside the machine
  double step_dB = -6;          ///< level of each line over the one below
};

/// Lines n f_1 with levels L + (n - 1) step. The level is that of a wave that leaves to both sides of a pipe
/// that goes on: p = Zc/2 q, q = 2 sqrt(2) p_rms / Zc. Phases -pi n (n - 1) / N keep the sum's crest low
/// (Schroeder, IEEE Trans. Inf. Theory 16, 85 (1970)).
std::vector<Tone> CalcHarmonics(const HarmonicSeries& series, double impedance_Pa_s_m3);

/// A machine where it sounds.
struct ToneSource {
  std::string id;
  int pipe = 0;
  double s_m = 0;
  SoundingTimes times{};
  std::vector<Tone> tones;

  PipePlace place() const { return {pipe, s_m}; }
};

/// The tones of a scene as a moving hydrophone records them:
///   p(t) = Re sum of H(f) share(t) Z(f, place(t)) q e^{i (2 pi f t + phi)},   H = i f / (f_c + i f),
/// H the input stage. The phase goes with the place, so that the Doppler shift -(v/c) f of a listener who
/// leaves at v comes by itself, and nothing breaks where the listener changes pipes or blocks end. The
/// complex amplitude is worked out every 64 samples (4 ms at 16 kHz: 4 mm at 1 m/s, a phase of 0.2 rad at 3
/// kHz in plastic) and goes linearly in between, which is right within (0.2 rad)^2/8 = 0.5 %. Time is that of
/// the record: the few ppm of the robot's clock are no matter beside the slip of a motor.
class Tones {
 public:
  /// `hop` samples lie between two states of the listener. Throws InputError for a source whose first line
  /// lies at or above half the rate; higher lines that do are taken away, as the converter's filter does.
  Tones(const AcousticScene& scene, Rate rate, double high_pass_Hz, std::size_t hop);

  /// No tone in the scene.
  bool silent() const { return lines_.empty(); }
  /// Where the listener is at the end of the next hop; first of all where it is at sample 0. A listener in no
  /// pipe hears none. Does not allocate.
  void Advance(const ListenerState& listener);
  /// Adds the next pressure_Pa.size() samples, at most to the end of the hop.
  void Render(std::span<float> pressure_Pa);

 private:
  struct Line {
    std::size_t source = 0;
    std::size_t frequency = 0;  // of the field
    double f_Hz = 0;
    std::complex<double> gain;    // H q e^{i phi}
    std::complex<double> at_end;  // amplitude in Pa at the end of the hop
  };
  struct Moment {
    PipePlace place;
    TrueTime time{};
  };
  std::complex<double> CalcAmplitude(const Line& line, const Moment& listener) const;
  void RenderHop(Line& line, const Moment& begin, const Moment& end);
  void AddStretch(double f_Hz, std::size_t begin, std::complex<double> from, std::complex<double> to);

  Rate rate_;
  std::vector<SoundingTimes> times_;  // of the sources
  std::optional<NetworkField> field_;
  std::vector<Line> lines_;
  std::vector<double> hop_Pa_;
  std::size_t stretch_;            // samples from one amplitude to the next
  std::size_t used_ = 0;           // of the hop
  std::int64_t first_sample_ = 0;  // of the hop
  bool begun_ = false;
  Moment listener_;  // at the end of the hop
};

}  // namespace piperun::acoustics
