#include "acoustics/flow_noise.h"

#include <cmath>
#include <numbers>

#include "base/check.h"

namespace piperun::acoustics {
namespace {

using std::numbers::pi;

double CalcBlasiusFriction(double reynolds) { return 0.3164 / std::sqrt(std::sqrt(reynolds)); }

}  // namespace

WallFlow CalcWallFlow(double speed_m_s, double bore_radius_m, const WaterProperties& water) {
  Demand(speed_m_s > 0 && bore_radius_m > 0, "wall flow needs a speed and a bore");
  const double reynolds = speed_m_s * 2 * bore_radius_m / water.kinematic_viscosity_m2_s;
  WallFlow flow;
  flow.edge_speed_m_s = 1.2 * speed_m_s;
  flow.thickness_m = bore_radius_m;
  flow.wall_shear_Pa = CalcBlasiusFriction(reynolds) * water.density_kg_m3 * speed_m_s * speed_m_s / 8;
  const double friction_speed_squared = flow.wall_shear_Pa / water.density_kg_m3;
  flow.timescale_ratio =
      flow.thickness_m / flow.edge_speed_m_s * friction_speed_squared / water.kinematic_viscosity_m2_s;
  return flow;
}

double CalcWallPressurePsd(const WallFlow& flow, double f_Hz) {
  const double timescale_s = flow.thickness_m / flow.edge_speed_m_s;
  const double x = 2 * pi * f_Hz * timescale_s;
  const double overlap = std::pow(std::sqrt(x) * std::sqrt(std::sqrt(x)) + 0.5, 3.7);
  const double viscous = 1.1 * std::pow(flow.timescale_ratio, -0.57) * x;
  const double viscous_cubed = viscous * viscous * viscous;
  const double shape = 3 * x * x / (overlap + viscous_cubed * viscous_cubed * viscous);
  return 2 * pi * shape * flow.wall_shear_Pa * flow.wall_shear_Pa * timescale_s;
}

double CalcFaceAveraging(const WallFlow& flow, double face_radius_m, double f_Hz) {
  const double convection_speed_m_s = 0.7 * flow.edge_speed_m_s;
  const double y = 1 + 2 * pi * f_Hz * face_radius_m / convection_speed_m_s;
  return 1 / (y * y);
}

}  // namespace piperun::acoustics
