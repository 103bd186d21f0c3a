#include "estimator/pipe_loss.h"

#include <cmath>
#include <numbers>

#include "base/water.h"

namespace piperun::estimator {

double CalcAttenuation_dB_m(const Pipe& pipe, double f_Hz) {
  const WaterProperties water = CalcWater(10);
  const double bulk_Pa = water.density_kg_m3 * water.sound_speed_m_s * water.sound_speed_m_s;
  const double h_m = pipe.wall_thickness_m;
  const double X = 2 * bulk_Pa * (pipe.radius_m() + 0.5 * h_m) / (pipe.material.young_modulus_Pa * h_m);
  const double c_m_s = water.sound_speed_m_s / std::sqrt(1 + X);
  const double alpha_Np_m =
      2 * std::numbers::pi * f_Hz / c_m_s * pipe.material.loss_factor * X / (2 * (1 + X));
  return 20 / std::numbers::ln10 * alpha_Np_m;
}

}  // namespace piperun::estimator
