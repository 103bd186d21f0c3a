#pragma once

#include <cmath>
#include <vector>

#include "sim/network/hydraulic_state.h"
#include "sim/network/link_law.h"
#include "sim/network/model.h"

namespace piperun::sim {

/// Decides which links open, close or begin to control, given heads and flows; after EPANET's rules (Rossman
/// 2020, chapter 12.1), in its order.
class StatusRules {
 public:
  /// Both must outlive the rules.
  StatusRules(const HydraulicModel& model, const LinkLaws& laws);

  /// Pressure reducing and sustaining valves. True when one changed.
  bool UpdatePressureValves(HydraulicState& state) const;
  /// Check valves, pumps that cannot lift so high, flow control valves, links at full and empty tanks.
  bool UpdateLinks(HydraulicState& state) const;
  /// Simple controls that look at a junction's pressure.
  bool UpdatePressureControls(HydraulicState& state) const;

 private:
  LinkStatus FindReducing(const HydraulicState& state, int link, int valve) const;
  LinkStatus FindSustaining(const HydraulicState& state, int link, int valve) const;
  LinkStatus FindFlowControl(const HydraulicState& state, int link, LinkStatus status) const;
  LinkStatus FindCheckValve(LinkStatus status, double head_drop_m, double flow_m3_s) const;
  LinkStatus FindAtTank(const HydraulicState& state, int link) const;
  bool IsBlocked(const HydraulicState& state, int link, int tank_node, int other, double outflow_m3_s) const;
  LinkStatus FindStatus(const HydraulicState& state, int link) const;

  const HydraulicModel& model_;
  const LinkLaws& laws_;
  double head_tolerance_m_;
  double flow_tolerance_m3_s_;
  std::vector<int> watched_;  ///< links whose status UpdateLinks may change
};

}  // namespace piperun::sim
