#pragma once

#include <vector>

#include "sim/network/fixed_power.h"
#include "sim/network/head_loss.h"
#include "sim/network/hydraulic_state.h"
#include "sim/network/model.h"
#include "sim/network/pump_law.h"

namespace piperun::sim {

/// What the links of a network do to the water: head loss and its slope at a flow, in a status, at a setting.
/// Control valves that pin a pressure or a flow are the solver's; here they are what they are when open or
/// closed.
class LinkLaws {
 public:
  explicit LinkLaws(const HydraulicModel& model);

  /// Head loss of every link at the flows of a state.
  void CalcLosses(const HydraulicState& state, std::vector<HeadLoss>& losses) const;

  HeadLoss CalcPumpLoss(int pump, double flow_m3_s, double speed) const;
  HeadLoss CalcValveLoss(int valve, double flow_m3_s, LinkStatus status, double setting) const;

  /// First guess of a link's flow: 1 ft/s in a pipe or valve, the design flow of a pump.
  double FirstFlow_m3_s(int link, LinkStatus status, double setting) const;
  /// Head a pump gives at no flow and a speed; unlimited at constant power.
  double ShutoffHead_m(int pump, double speed) const;
  bool IsConstantPower(int pump) const { return pumps_[pump].kind == PumpKind::kConstantPower; }
  double FirstPumpFlow_m3_s(int pump) const { return pumps_[pump].law.first_flow_m3_s; }
  /// Head lost in a fully open valve.
  double CalcOpenLoss_m(int valve, double flow_m3_s) const;

 private:
  struct Pump {
    PumpKind kind;
    PumpLaw law;
    Curve curve;
    double power_coefficient_m4_s;
  };
  struct Valve {
    ValveKind kind;
    double diameter_m;
    double minor_s2_m5;
    Curve curve;
  };
  HeadLoss CalcControlledLoss(const Valve& valve, double flow_m3_s, double setting) const;
  void CalcPipeLosses(const HydraulicState& state, std::vector<HeadLoss>& losses) const;

  HeadLossLaw law_;
  FixedPower power_;  ///< |q|^(n-1) of h = r |q|^(n-1) q
  double least_slope_s_m2_;
  std::vector<PipeResistance> pipes_;
  std::vector<double> first_pipe_flow_m3_s_;
  std::vector<Pump> pumps_;
  std::vector<Valve> valves_;
};

/// A closed link: lets next to nothing through, so that the equations keep a solution.
HeadLoss CalcClosedLoss(double flow_m3_s);

/// Loss coefficient of a positional valve: K = K_open / (Kv/Kvo)^2, Kv/Kvo from its curve over the opening,
/// or equal to it.
double CalcPositionalLoss(double opening_percent, double open_loss, const Curve& curve);

}  // namespace piperun::sim
