#pragma once

#include <optional>

#include "base/params.h"

namespace piperun::sim {

/// How a part inside the ball takes on the temperature of the water: one lumped heat capacity behind one heat
/// conductance (Biot number of the part below 0.1, water at one temperature).
struct ThermalParams {
  double initial_C = 20;                  ///< at release
  std::optional<double> time_constant_s;  ///< nothing: heat capacity / conductance
  double heat_capacity_J_K = 100;         ///< mass times specific heat of what warms together
  double conductance_W_K = 0.25;          ///< through air gap, shell and the water's film, in series

  void Visit(ParamVisitor& v);
};

/// tau = C / G, or the one that is given; s.
double CalcTimeConstant_s(const ThermalParams& params);

/// T(t) = T_w + (T_0 - T_w) exp(-t / tau): the solution of C dT/dt = -G (T - T_w) from T_0 at release. `t_s`
/// since release, >= 0.
double CalcTemperature_C(const ThermalParams& params, double water_C, double t_s);

}  // namespace piperun::sim
