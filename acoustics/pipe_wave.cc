#include "acoustics/pipe_wave.h"

#include <cmath>
#include <numbers>
#include <string>

#include "base/check.h"
#include "base/number.h"

namespace piperun::acoustics {
namespace {

using std::numbers::pi;

constexpr double kFirstTransverseMode = 1.8412;  // first zero of J1'

void RequirePositive(double value, const std::string& key) {
  if (value > 0 && std::isfinite(value)) return;
  throw InputError(FormatNumber(value) + " is not allowed; it must be a finite number > 0", key);
}

void RequireWall(const WallMaterial& wall) {
  RequirePositive(wall.young_modulus_Pa, "material.young_modulus_Pa");
  RequirePositive(wall.density_kg_m3, "material.density_kg_m3");
  if (!(wall.poisson_ratio > -1 && wall.poisson_ratio <= 0.5)) {
    throw InputError(FormatNumber(wall.poisson_ratio) + " is not allowed; it must lie in (-1, 0.5]",
                     "material.poisson_ratio");
  }
  if (!(wall.loss_factor >= 0 && wall.loss_factor < 1)) {
    throw InputError(FormatNumber(wall.loss_factor) + " is not allowed; it must lie in [0, 1)",
                     "material.loss_factor");
  }
}

double CalcPlateSpeed(const WallMaterial& wall) {
  return std::sqrt(wall.young_modulus_Pa /
                   (wall.density_kg_m3 * (1 - wall.poisson_ratio * wall.poisson_ratio)));
}

}  // namespace

double PipeWave::Attenuation_Np_m(double f_Hz) const {
  const double omega = 2 * pi * f_Hz;
  const double wall = omega / speed_m_s * loss_factor * X / (2 * (1 + X));
  const double viscous = std::sqrt(omega * kinematic_viscosity_m2_s / 2) / (bore_radius_m * speed_m_s);
  return wall + viscous;
}

PipeWave CalcPipeWave(double bore_diameter_m, double wall_thickness_m, const WallMaterial& wall,
                      const WaterProperties& water) {
  RequirePositive(bore_diameter_m, "diameter_m");
  RequirePositive(wall_thickness_m, "wall_thickness_m");
  RequireWall(wall);
  const double bore_radius_m = 0.5 * bore_diameter_m;
  const double mean_radius_m = bore_radius_m + 0.5 * wall_thickness_m;
  const double bulk_modulus_Pa = water.density_kg_m3 * water.sound_speed_m_s * water.sound_speed_m_s;
  PipeWave wave;
  wave.X = 2 * bulk_modulus_Pa * mean_radius_m / (wall.young_modulus_Pa * wall_thickness_m);
  wave.speed_m_s = water.sound_speed_m_s / std::sqrt(1 + wave.X);
  wave.loss_factor = wall.loss_factor;
  wave.bore_radius_m = bore_radius_m;
  wave.area_m2 = pi * bore_radius_m * bore_radius_m;
  wave.kinematic_viscosity_m2_s = water.kinematic_viscosity_m2_s;
  wave.impedance_Pa_s_m3 = water.density_kg_m3 * wave.speed_m_s / wave.area_m2;
  wave.ring_frequency_Hz = CalcPlateSpeed(wall) / (2 * pi * mean_radius_m);
  wave.cut_on_Hz = kFirstTransverseMode * water.sound_speed_m_s / (2 * pi * bore_radius_m);
  return wave;
}

}  // namespace piperun::acoustics
