#pragma once

#include <memory>
#include <string>
#include <vector>

#include "acoustics/ambient.h"
#include "acoustics/pipe_wave.h"
#include "acoustics/source.h"
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
  std::vector<AcousticLeg> legs;  ///< in order of chainage, without gaps; at least one
  std::vector<SoundingLeak> leaks;
  AmbientParams ambient;
  WaterProperties water;
};

/// Spectrum at the hole, p = Zc/2 q in each direction of the pipe that goes on both ways:
/// (Zc/2)^2 S_q(f), one-sided, in Pa^2/Hz; Zc of the leg that holds the leak. Range f >= 0.
double CalcLeakPsdAtHole(const AcousticScene& scene, const SoundingLeak& leak, double f_Hz);

/// Spectrum of a leak in the water at a chainage: CalcLeakPsdAtHole times exp(-2 CalcPathLoss_Np).
double CalcLeakPsd(const AcousticScene& scene, const SoundingLeak& leak, double chainage_m, double f_Hz);

/// Spectrum of everything in the water that is not a leak, on a hydrophone face of the given radius: distant
/// noise and, where the scene has it, the wall pressure of the eddies that pass. One-sided, Pa^2/Hz, f > 0.
double CalcBackgroundPsd(const AcousticScene& scene, const ListenerState& listener, double face_radius_m,
                         double f_Hz);

}  // namespace piperun::acoustics
