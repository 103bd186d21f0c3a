#include "sim/thermal.h"

#include <cmath>

namespace piperun::sim {

void ThermalParams::Visit(ParamVisitor& v) {
  v.Number({"initial_C", "Temperature at release."}, Range::Between(-40, 125), initial_C);
  v.NumberOr({"time_constant_s", "Time constant of the approach to the water's temperature."},
             Range::Positive(), "from_heat_capacity", time_constant_s);
  v.Number({"heat_capacity_J_K", "Heat capacity of what warms together."}, Range::Positive(),
           heat_capacity_J_K);
  v.Number({"conductance_W_K", "Heat conductance from there to the water."}, Range::Positive(),
           conductance_W_K);
}

double CalcTimeConstant_s(const ThermalParams& p) {
  return p.time_constant_s.value_or(p.heat_capacity_J_K / p.conductance_W_K);
}

double CalcTemperature_C(const ThermalParams& p, double water_C, double t_s) {
  return water_C + (p.initial_C - water_C) * std::exp(-t_s / CalcTimeConstant_s(p));
}

}  // namespace piperun::sim
