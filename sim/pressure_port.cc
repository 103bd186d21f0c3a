#include "sim/pressure_port.h"

#include <algorithm>
#include <array>

#include "base/check.h"

namespace piperun::sim {
namespace {

double CalcPressureCoefficient(const PressurePortParams& params, const Vector3d& port_W,
                               const Vector3d& slip_W) {
  if (params.dynamic == "constant") return params.pressure_coefficient;
  const double cos_theta = std::clamp(-port_W.normalized().dot(slip_W.normalized()), -1.0, 1.0);
  return CalcSpherePressureCoefficient(cos_theta, params.base_pressure_coefficient);
}

}  // namespace

void PressurePortParams::Visit(ParamVisitor& v) {
  static constexpr std::array<std::string_view, 3> kLaws{"none", "sphere", "constant"};
  v.Vector({"port_m", "Where the port opens, in B: it feels the water's weight down to there."},
           Range::Between(-1, 1), port_m);
  v.Choice({"dynamic",
            "Dynamic pressure by the water's velocity relative to the ball: none, on the skin of a sphere at "
            "the port's angle to it, or a constant coefficient times rho u^2 / 2."},
           kLaws, dynamic);
  v.Number({"pressure_coefficient", "C_p of `dynamic: constant`."}, Range::Between(-10, 10),
           pressure_coefficient);
  v.Number({"base_pressure_coefficient", "C_p in the wake of `dynamic: sphere`."}, Range::Between(-1.25, 1),
           base_pressure_coefficient);
}

void PressurePortParams::Check() const {
  if (dynamic == "sphere" && port_m.isZero(0)) {
    throw InputError("[0, 0, 0] has no direction; `dynamic: sphere` needs a port on the skin", "port_m");
  }
}

double CalcSpherePressureCoefficient(double cos_theta, double base_pressure_coefficient) {
  if (cos_theta <= 0) return base_pressure_coefficient;
  return std::max(1 - 2.25 * (1 - cos_theta * cos_theta), base_pressure_coefficient);
}

double CalcPortPressure_Pa(const PressurePortParams& params, const TruthState& truth,
                           const Vector3d& gravity_W, double density_kg_m3) {
  const Vector3d port_W = truth.X_WB.q * params.port_m;
  const double static_Pa = truth.pressure_Pa + density_kg_m3 * gravity_W.dot(port_W);
  const double slip2 = truth.v_slip_W.squaredNorm();
  if (params.dynamic == "none" || slip2 == 0) return static_Pa;
  return static_Pa + 0.5 * density_kg_m3 * slip2 * CalcPressureCoefficient(params, port_W, truth.v_slip_W);
}

}  // namespace piperun::sim
