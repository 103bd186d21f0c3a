#pragma once

#include <string_view>

#include "acoustics/pipe_wave.h"
#include "base/params.h"

namespace piperun::acoustics {

inline WallMaterial MakeWall(double young_modulus_Pa, double loss_factor, double poisson_ratio = 0.4,
                             double density_kg_m3 = 1400) {
  return {"", young_modulus_Pa, loss_factor, poisson_ratio, density_kg_m3, 0};
}

/// Water at 10 C as the published tables use it.
inline WaterProperties MakeWater10C() { return CalcWater(10); }

/// PVC-U DN150: mean radius 77.5 mm, wall 7.5 mm.
inline constexpr double kPvcBore_m = 0.1475;
inline PipeWave MakePvcWave() {
  return CalcPipeWave(kPvcBore_m, 0.0075, MakeWall(3.5e9, 0.05), MakeWater10C());
}

/// Ductile iron DN150 K9: mean radius 82 mm, wall 6 mm.
inline PipeWave MakeIronWave() {
  return CalcPipeWave(0.158, 0.006, MakeWall(165e9, 0.02, 0.28, 7100), MakeWater10C());
}

}  // namespace piperun::acoustics
