#pragma once

#include <complex>
#include <cstdint>
#include <span>
#include <vector>

#include "acoustics/ambient.h"
#include "base/random.h"
#include "base/time.h"

namespace piperun::acoustics {

/// A sphere that a wall strikes, with a hydrophone in its surface.
struct StruckBall {
  double radius_m = 0.03;
  double mass_kg = 0.1244;  ///< its own, without water
  bool gives_way = false;   ///< soft shell: its blows take the time that the contact takes
};

/// A blow on the ball: the force F(t) = pi J/(2 T) sin(pi t/T), 0 < t < T.
struct Knock {
  TrueTime time{};            ///< of its beginning; sample n is at SampleTime(n, rate)
  double impulse_N_s = 0;     ///< J >= 0
  double contact_time_s = 0;  ///< T > 0
};

/// Pressure on the surface of a sphere that a force F accelerates in still water, over that force:
///
///   p/F = rho r / (2 (m + rho V/2)) <cos^2 theta>^(1/2),   <cos^2 theta> = 1/3
///
/// A sphere with acceleration a in unbounded incompressible water has the surface pressure rho r a/2 cos
/// theta, theta from a (its integral is the added mass rho V/2; Lamb, Hydrodynamics, art. 92; derived).
/// Incompressible: r much below the wavelength, here up to some 5 kHz. The rms over all directions stands for
/// a face that looks anywhere: one that is turned to the force hears 4.8 dB more, one across it nothing. The
/// wall nearby (added mass 0.8 instead of 0.5 rho V towards it) makes up to 2 dB. In Pa/N.
double CalcNearPressure_Pa_per_N(const StruckBall& ball, double density_kg_m3);

/// How much of the ring a blow of duration T excites at a frequency, 1/(1 + (2 f T)^2): the envelope of a
/// half sine's spectrum |cos(pi f T)/(1 - (2 f T)^2)| without its zeros.
double CalcRingShare(double f_Hz, double contact_time_s);

/// What a hydrophone in the ball records of knocks, in pascals, sample by sample: the near pressure of the
/// accelerated ball,
///
///   p(t) = (p/F) F(t), mean over the period that ends at the sample (so that its integral is that of F,
///   wherever the knock begins between samples),
///
/// and the ring of pipe and shell, 16 modes at f_i spread evenly over the logarithm of the ring's band,
///
///   p(t) = sum_i a_i cos(2 pi f_i t + phi_i) 10^(-t/T_20),   a_i = L J sqrt(2/16) CalcRingShare(f_i, T)
///
/// with phases of its own for every knock; modes from the Nyquist frequency on are left out. Both pass the
/// first-order input stage (bilinear, corner exact). Reflections are not in it.
///
/// Phases are keyed by the knock's time: of the stream, slots from kFirstSlot on.
class ImpactSound {
 public:
  static constexpr std::uint64_t kFirstSlot = std::uint64_t{1} << 32;

  /// Throws as ImpactParams::Check does.
  ImpactSound(const ImpactParams& params, const StruckBall& ball, double density_kg_m3, Rate rate,
              double high_pass_Hz, const RandomStream& random);

  /// A knock that begins at or after the next sample (aborts otherwise), in any order. Nothing when knocks
  /// are switched off, or for one that is not finite (a run that has gone wrong).
  void Add(const Knock& knock);
  /// Nothing to be heard until the next Add().
  bool silent() const { return knocks_.empty() && !ringing_ && out_Pa_ == 0; }
  /// Adds the next pressure_Pa.size() samples. Does not allocate.
  void Render(std::span<float> pressure_Pa);

 private:
  static constexpr std::size_t kModes = 16;

  struct Mode {
    double f_Hz = 0;
    std::complex<double> pole;   // log of what a sample multiplies the state by
    std::complex<double> step;   // exp(pole)
    std::complex<double> state;  // its real part is the pressure
  };

  double RenderSample(TrueTime t);
  double CalcNearPressure_Pa(const Knock& knock, TrueTime t) const;
  void StrikeModes(const Knock& knock, TrueTime t);
  void AdvanceRing();
  double CalcRing_Pa() const;
  double PassInputStage(double in_Pa);
  void DropPastKnocks(TrueTime t);

  ImpactParams params_;
  double Pa_per_N_;
  Rate rate_;
  RandomStream random_;
  double high_pass_pole_;
  std::vector<Mode> modes_;
  std::vector<Knock> knocks_;  // by time; those that are to come or still push
  std::size_t struck_ = 0;     // as many of them ring already
  bool ringing_ = false;
  double in_Pa_ = 0, out_Pa_ = 0;  // of the input stage
  std::int64_t next_sample_ = 0;
};

}  // namespace piperun::acoustics
