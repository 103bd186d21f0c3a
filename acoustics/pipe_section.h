#pragma once

#include <optional>
#include <vector>

#include "acoustics/soil.h"
#include "base/network.h"

namespace piperun::acoustics {

/// One layer of a pipe's wall. Layers stick together: a lining is one.
struct WallLayer {
  double thickness_m = 0;
  WallMaterial material;
};

/// By which law a wall answers the sound in it (pipe_wave.h).
enum class WaveLaw {
  kAuto,         ///< compact where that is good, then with the wall's inertia
  kCompact,      ///< Korteweg's: a massless wall in air
  kWallInertia,  ///< a wall with mass, at all frequencies
};

/// The cross-section of a pipe as sound feels it.
struct PipeSection {
  double bore_diameter_m = 0;     ///< of the water
  std::vector<WallLayer> layers;  ///< one at least
  std::optional<Soil> soil{};     ///< nothing: air or water outside, which hardly holds the wall
  WaveLaw law = WaveLaw::kAuto;
};

/// A thin ring of all the layers, of the mean radius a = a_i + (sum of h)/2: what they share is one radial
/// displacement, so the stiffness and mass of each add up,
///
///   K_p = sum of E h / a^2,   m = sum of rho h,   eta = (sum of eta E h) / (sum of E h).
struct WallRing {
  double mean_radius_m = 0;
  double stiffness_Pa_m = 0;     ///< K_p
  double mass_kg_m2 = 0;         ///< m
  double loss_factor = 0;        ///< eta
  double ring_frequency_Hz = 0;  ///< sqrt((sum of E h/(1 - nu^2)) / m) / (2 pi a), Poisson's ratio by layer
};

/// Throws InputError for a size, modulus or density that is not a positive number, a Poisson's ratio outside
/// (-1, 0.5] and a loss factor outside [0, 1).
WallRing CalcWallRing(const PipeSection& section);

}  // namespace piperun::acoustics
