#include "acoustics/pipe_section.h"

#include <cmath>
#include <numbers>
#include <string>

#include "base/check.h"
#include "base/number.h"

namespace piperun::acoustics {
namespace {

void RequirePositive(double value, const std::string& key) {
  if (value > 0 && std::isfinite(value)) return;
  throw InputError(FormatNumber(value) + " is not allowed; it must be a finite number > 0", key);
}

void RequireMaterial(const WallMaterial& wall) {
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

}  // namespace

WallRing CalcWallRing(const PipeSection& section) {
  RequirePositive(section.bore_diameter_m, "diameter_m");
  Demand(!section.layers.empty(), "a pipe has a wall");
  double thickness_m = 0, hoop_N_m = 0, lossy_N_m = 0, plate_N_m = 0, mass_kg_m2 = 0;
  for (const WallLayer& layer : section.layers) {
    RequirePositive(layer.thickness_m, "wall_thickness_m");
    RequireMaterial(layer.material);
    const double E_h = layer.material.young_modulus_Pa * layer.thickness_m, nu = layer.material.poisson_ratio;
    thickness_m += layer.thickness_m;
    hoop_N_m += E_h;
    lossy_N_m += E_h * layer.material.loss_factor;
    plate_N_m += E_h / (1 - nu * nu);
    mass_kg_m2 += layer.material.density_kg_m3 * layer.thickness_m;
  }
  const double a_m = 0.5 * (section.bore_diameter_m + thickness_m);
  return {a_m, hoop_N_m / (a_m * a_m), mass_kg_m2, lossy_N_m / hoop_N_m,
          std::sqrt(plate_N_m / mass_kg_m2) / (2 * std::numbers::pi * a_m)};
}

}  // namespace piperun::acoustics
