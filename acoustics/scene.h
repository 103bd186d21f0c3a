#pragma once

#include <complex>
#include <memory>
#include <string>
#include <vector>

#include "acoustics/acoustic_network.h"
#include "acoustics/ambient.h"
#include "acoustics/impact.h"
#include "acoustics/sounding_times.h"
#include "acoustics/source.h"
#include "acoustics/tones.h"
#include "base/water.h"

namespace piperun::acoustics {

/// What the hydrophone knows of the ball that carries it, at an instant.
struct ListenerState {
  int pipe = -1;  ///< -1: in no pipe; it hears no leak and no eddies along a wall
  double s_m = 0;
  double water_speed_m_s = 0;  ///< bulk velocity where the ball is
  double slip_speed_m_s = 0;   ///< |water speed - ball speed|
  double bore_radius_m = 0;
  TrueTime time{};               ///< when that is
  double rolling_speed_m_s = 0;  ///< of a ball that touches the wall, along the pipe; else zero

  PipePlace place() const { return {pipe, s_m}; }
};

/// What a localised source of noise is. All are heard alike; only a leak is looked for.
enum class Role { kLeak, kDrawOff, kValve, kGasPocket };

/// A leak, or another localised source of noise, where it sounds.
struct SoundingLeak {
  std::string id;
  int pipe = 0;
  double s_m = 0;
  std::shared_ptr<const LeakSound> sound;
  Role role = Role::kLeak;
  SoundingTimes times{};

  PipePlace place() const { return {pipe, s_m}; }
};

/// The acoustic world of one run: all pipes of the network, its sources, its background, the ball.
struct AcousticScene {
  AcousticNetwork network;
  std::vector<int> listening_pipes;  ///< where the ball can be, rising; empty: in all
  std::vector<SoundingLeak> leaks;   ///< and what else sounds like one
  std::vector<ToneSource> tones;
  AmbientParams ambient;
  WaterProperties water;
  StruckBall ball;  ///< that the hydrophone sits in
};

/// Spectrum at the hole, p = Zc/2 q in each direction of the pipe that goes on both ways:
/// (Zc/2)^2 S_q(f), one-sided, in Pa^2/Hz; Zc at f of the pipe that holds the leak. Range f >= 0.
double CalcLeakPsdAtHole(const AcousticScene& scene, const SoundingLeak& leak, double f_Hz);

/// Spectrum of a leak in the water at a place: |Z|^2 S_q with Z of network_field.h, and in the pipe of the
/// hole what near_field.h and higher_modes.h add to CalcLeakPsdAtHole. Zero where no sound comes. Solves the
/// network: for checks and for a few frequencies; a record takes bin_field.h.
double CalcLeakPsd(const AcousticScene& scene, const SoundingLeak& leak, const PipePlace& place, double f_Hz);
/// The same from an impedance that is known.
double CalcLeakPsd(const AcousticScene& scene, const SoundingLeak& leak,
                   const std::complex<double>& impedance_Pa_s_m3, const PipePlace& place, double f_Hz);

/// Spectrum of everything in the water that is not a leak, on a hydrophone face of the given radius: distant
/// noise, the rolling of a ball and, in a pipe of a scene that has it, the wall pressure of the eddies that
/// pass. One-sided, Pa^2/Hz, f > 0.
double CalcBackgroundPsd(const AcousticScene& scene, const ListenerState& listener, double face_radius_m,
                         double f_Hz);

/// How far from the axis the hydrophone is in a ball that runs along the wall, over the bore's radius.
double CalcListeningRadius(const StruckBall& ball, double bore_radius_m);

/// How fast a ball rolls whose rolling is heard: zero for a soft one, for one in no pipe and where the scene
/// leaves rolling out.
double CalcRollingSpeed(const AcousticScene& scene, const ListenerState& listener);

}  // namespace piperun::acoustics
