#include "acoustics/pipe_wave.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/check.h"
#include "base/number.h"

namespace piperun::acoustics {
namespace {

using std::numbers::pi;
using Complex = std::complex<double>;

constexpr double kFirstTransverseMode = 1.8412;                              // first zero of J1'
constexpr double kCompactTo = 0.1, kInertiaFrom = 0.125, kInertiaTo = 0.15;  // in ring frequencies
constexpr double kNamedInertiaTo = 0.5;
constexpr int kSoilSteps = 64;
constexpr int kMostIterations = 200;

/// n of the compact law.
Complex CalcCompactIndex(const PipeWave& wave) {
  return {1, -wave.loss_factor * wave.X / (2 * (1 + wave.X))};
}

/// n of the other. `soil` is K_s/K_p, `soil_at_rest` at zero frequency.
Complex CalcInertiaIndex(const PipeWave& wave, double f_Hz, Complex soil, double soil_at_rest) {
  const double ratio = f_Hz / wave.breathing_frequency_Hz;
  const Complex D = Complex(1 - ratio * ratio, wave.loss_factor) + soil;
  return std::sqrt((1.0 + wave.X / D) / (1 + wave.X / (1 + soil_at_rest)));
}

/// 0 up to `from`, 1 from `to` on, with even slopes.
double CalcSmoothStep(double x, double from, double to) {
  const double u = std::clamp((x - from) / (to - from), 0.0, 1.0);
  return u * u * (3 - 2 * u);
}

Complex Interpolate(const std::vector<Complex>& values, double place) {
  const auto last = static_cast<double>(values.size() - 1);
  const auto i = static_cast<std::size_t>(std::min(std::floor(place), last - 1));
  const double share = place - static_cast<double>(i);
  return values[i] + share * (values[i + 1] - values[i]);
}

/// n at a frequency in soil: the stiffness of the soil depends on Re k, which is found by iterating.
Complex SolveSoilIndex(const PipeWave& wave, const WallRing& ring, const Soil& soil, double f_Hz, Complex n) {
  const double omega = 2 * pi * f_Hz, at_rest = 2 * soil.shear_modulus_Pa / ring.mean_radius_m;
  for (int i = 0; i < kMostIterations; ++i) {
    const double k_rad_m = omega / wave.speed_m_s * n.real();
    const Complex stiffness = CalcSoilStiffness_Pa_m(soil, ring.mean_radius_m, omega, k_rad_m);
    const Complex next =
        CalcInertiaIndex(wave, f_Hz, stiffness / ring.stiffness_Pa_m, at_rest / ring.stiffness_Pa_m);
    if (std::abs(next - n) < 1e-12) return next;
    n = next;
  }
  throw InputError("at " + FormatNumber(f_Hz) +
                       " Hz the wave of this pipe in this soil radiates too much to be told; choose another "
                       "soil, or none",
                   "soil");
}

std::vector<Complex> TabulateSoilIndices(const PipeWave& wave, const WallRing& ring, const Soil& soil) {
  const double at_rest = 2 * soil.shear_modulus_Pa / (ring.mean_radius_m * ring.stiffness_Pa_m);
  std::vector<Complex> indices{CalcInertiaIndex(wave, 0, at_rest, at_rest)};
  for (int i = 1; i <= kSoilSteps; ++i) {
    const double f_Hz = kInertiaTo * wave.ring_frequency_Hz * i / kSoilSteps;
    indices.push_back(SolveSoilIndex(wave, ring, soil, f_Hz, indices.back()));
  }
  return indices;
}

void SetSoil(const WallRing& ring, const PipeSection& section, const WaterProperties& water, PipeWave& wave) {
  const Soil& soil = *section.soil;
  RequireSoil(soil);
  if (section.law == WaveLaw::kCompact) {
    throw InputError("compact is not allowed in soil, of which that law knows nothing; choose auto",
                     "wave_law");
  }
  const double at_rest = 2 * soil.shear_modulus_Pa / (ring.mean_radius_m * ring.stiffness_Pa_m);
  wave.speed_m_s = water.sound_speed_m_s / std::sqrt(1 + wave.X / (1 + at_rest));
  wave.soil_indices = TabulateSoilIndices(wave, ring, soil);
}

}  // namespace

double PipeWave::held_from_Hz() const {
  if (law == WaveLaw::kCompact) return std::numeric_limits<double>::infinity();
  const bool goes_on = law == WaveLaw::kWallInertia && soil_indices.empty();
  return (goes_on ? kNamedInertiaTo : kInertiaTo) * ring_frequency_Hz;
}

Complex PipeWave::CalcIndex(double f_Hz) const {
  const Complex compact = CalcCompactIndex(*this);
  if (law == WaveLaw::kCompact) return compact;
  const double held_Hz = held_from_Hz(), told_Hz = std::min(f_Hz, held_Hz);
  if (!soil_indices.empty())
    return Interpolate(soil_indices, told_Hz / held_Hz * static_cast<double>(soil_indices.size() - 1));
  const double share = law == WaveLaw::kWallInertia
                           ? 1
                           : CalcSmoothStep(told_Hz / ring_frequency_Hz, kCompactTo, kInertiaFrom);
  if (share == 0) return compact;
  return (1 - share) * compact + share * CalcInertiaIndex(*this, told_Hz, 0, 0);
}

Complex PipeWave::Wavenumber_rad_m(double f_Hz) const {
  const double omega = 2 * pi * f_Hz;
  const Complex n = CalcIndex(f_Hz);
  const double friction = std::sqrt(omega * kinematic_viscosity_m2_s / 2) / (bore_radius_m * speed_m_s);
  return omega / speed_m_s * n - Complex(0, friction * n.real());
}

double PipeWave::Speed_m_s(double f_Hz) const { return speed_m_s / CalcIndex(f_Hz).real(); }

double PipeWave::Attenuation_Np_m(double f_Hz) const { return -Wavenumber_rad_m(f_Hz).imag(); }

double PipeWave::CharacteristicImpedance_Pa_s_m3(double f_Hz) const {
  return impedance_Pa_s_m3 / CalcIndex(f_Hz).real();
}

PipeWave CalcPipeWave(const PipeSection& section, const WaterProperties& water) {
  const WallRing ring = CalcWallRing(section);
  const double bulk_modulus_Pa = water.density_kg_m3 * water.sound_speed_m_s * water.sound_speed_m_s;
  PipeWave wave;
  wave.law = section.law;
  wave.X = 2 * bulk_modulus_Pa / (ring.mean_radius_m * ring.stiffness_Pa_m);
  wave.speed_m_s = water.sound_speed_m_s / std::sqrt(1 + wave.X);
  wave.loss_factor = ring.loss_factor;
  wave.bore_radius_m = 0.5 * section.bore_diameter_m;
  wave.area_m2 = pi * wave.bore_radius_m * wave.bore_radius_m;
  wave.kinematic_viscosity_m2_s = water.kinematic_viscosity_m2_s;
  wave.ring_frequency_Hz = ring.ring_frequency_Hz;
  wave.breathing_frequency_Hz = std::sqrt(ring.stiffness_Pa_m / ring.mass_kg_m2) / (2 * pi);
  wave.cut_on_Hz = kFirstTransverseMode * water.sound_speed_m_s / (2 * pi * wave.bore_radius_m);
  if (section.soil) SetSoil(ring, section, water, wave);
  wave.impedance_Pa_s_m3 = water.density_kg_m3 * wave.speed_m_s / wave.area_m2;
  return wave;
}

PipeWave CalcPipeWave(double bore_diameter_m, double wall_thickness_m, const WallMaterial& wall,
                      const WaterProperties& water) {
  return CalcPipeWave({bore_diameter_m, {{wall_thickness_m, wall}}, std::nullopt, WaveLaw::kCompact}, water);
}

}  // namespace piperun::acoustics
