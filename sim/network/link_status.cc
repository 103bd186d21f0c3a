#include "sim/network/link_status.h"

#include <cmath>

#include "sim/network/link_action.h"

namespace piperun::sim {
namespace {

bool IsFlowControl(const HydraulicModel& model, int link) {
  return link >= model.first_valve() &&
         model.valves[link - model.first_valve()].kind == ValveKind::kFlowControl;
}

bool IsCheckValve(const HydraulicModel& model, int link) {
  return link < model.first_pump() && model.pipes[link].check_valve;
}

bool IsPump(const HydraulicModel& model, int link) {
  return link >= model.first_pump() && link < model.first_valve();
}

bool TouchesTank(const HydraulicModel& model, int link) {
  return model.From(link) >= model.first_tank() || model.To(link) >= model.first_tank();
}

}  // namespace

StatusRules::StatusRules(const HydraulicModel& model, const LinkLaws& laws)
    : model_(model),
      laws_(laws),
      head_tolerance_m_(model.options.head_tolerance_m),
      flow_tolerance_m3_s_(model.options.flow_tolerance_m3_s) {
  for (int link = 0; link < model.link_count(); ++link) {
    if (IsCheckValve(model, link) || IsPump(model, link) || IsFlowControl(model, link) ||
        TouchesTank(model, link)) {
      watched_.push_back(link);
    }
  }
}

bool StatusRules::UpdatePressureValves(HydraulicState& state) const {
  bool changed = false;
  for (std::size_t i = 0; i < model_.valves.size(); ++i) {
    const int valve = static_cast<int>(i), link = model_.first_valve() + valve;
    const ValveKind kind = model_.valves[i].kind;
    if (std::isnan(state.setting[link])) continue;
    LinkStatus status = state.status[link];
    if (kind == ValveKind::kPressureReducing) status = FindReducing(state, link, valve);
    if (kind == ValveKind::kPressureSustaining) status = FindSustaining(state, link, valve);
    changed = changed || status != state.status[link];
    state.status[link] = status;
  }
  return changed;
}

LinkStatus StatusRules::FindReducing(const HydraulicState& state, int link, int valve) const {
  const LinkStatus status = state.status[link];
  const double q = state.flow_m3_s[link], tolerance = head_tolerance_m_;
  const double h1 = state.head_m[model_.From(link)], h2 = state.head_m[model_.To(link)];
  const double goal = model_.Elevation_m(model_.To(link)) + state.setting[link];
  if (status == LinkStatus::kClosed) {
    if (h1 >= goal + tolerance && h2 < goal - tolerance) return LinkStatus::kActive;
    return h1 < goal - tolerance && h1 > h2 + tolerance ? LinkStatus::kOpen : status;
  }
  if (q < -flow_tolerance_m3_s_) return LinkStatus::kClosed;
  if (status == LinkStatus::kActive && h1 - laws_.CalcOpenLoss_m(valve, q) < goal - tolerance) {
    return LinkStatus::kOpen;
  }
  if (status == LinkStatus::kOpen && h2 >= goal + tolerance) return LinkStatus::kActive;
  return status;
}

LinkStatus StatusRules::FindSustaining(const HydraulicState& state, int link, int valve) const {
  const LinkStatus status = state.status[link];
  const double q = state.flow_m3_s[link], tolerance = head_tolerance_m_;
  const double h1 = state.head_m[model_.From(link)], h2 = state.head_m[model_.To(link)];
  const double goal = model_.Elevation_m(model_.From(link)) + state.setting[link];
  if (status == LinkStatus::kClosed) {
    if (h1 <= h2 + tolerance) return status;
    if (h2 > goal + tolerance) return LinkStatus::kOpen;
    return h1 >= goal + tolerance ? LinkStatus::kActive : status;
  }
  if (q < -flow_tolerance_m3_s_) return LinkStatus::kClosed;
  if (status == LinkStatus::kActive && h2 + laws_.CalcOpenLoss_m(valve, q) > goal + tolerance) {
    return LinkStatus::kOpen;
  }
  if (status == LinkStatus::kOpen && h1 < goal - tolerance) return LinkStatus::kActive;
  return status;
}

LinkStatus StatusRules::FindFlowControl(const HydraulicState& state, int link, LinkStatus status) const {
  const double drop = state.head_m[model_.From(link)] - state.head_m[model_.To(link)];
  const double q = state.flow_m3_s[link];
  if (drop < -head_tolerance_m_ || q < -flow_tolerance_m3_s_) return LinkStatus::kFlowShort;
  if (status == LinkStatus::kFlowShort && q >= state.setting[link]) return LinkStatus::kActive;
  return status;
}

LinkStatus StatusRules::FindCheckValve(LinkStatus status, double head_drop_m, double flow_m3_s) const {
  if (head_drop_m < -head_tolerance_m_ || flow_m3_s < -flow_tolerance_m3_s_) return LinkStatus::kClosed;
  return head_drop_m > head_tolerance_m_ ? LinkStatus::kOpen : status;
}

/// Does a full tank refuse the link's water, or an empty one have none to give? `outflow` leaves the tank.
bool StatusRules::IsBlocked(const HydraulicState& state, int link, int tank_node, int other,
                            double outflow_m3_s) const {
  const TankNode& tank = model_.tanks[tank_node - model_.first_tank()];
  const double head = state.head_m[tank_node], drop = head - state.head_m[other];
  const bool is_full = head >= tank.elevation_m + tank.max_level_m && !tank.can_overflow;
  const bool is_empty = head <= tank.elevation_m + tank.min_level_m;
  if (IsPump(model_, link)) {
    return (is_full && model_.To(link) == tank_node) || (is_empty && model_.From(link) == tank_node);
  }
  return (is_full && IsClosed(FindCheckValve(LinkStatus::kOpen, drop, outflow_m3_s))) ||
         (is_empty && !IsClosed(FindCheckValve(LinkStatus::kClosed, drop, outflow_m3_s)));
}

/// EPANET looks at one end only: the first that is a reservoir or tank.
LinkStatus StatusRules::FindAtTank(const HydraulicState& state, int link) const {
  const int from = model_.From(link), to = model_.To(link);
  const bool at_from = from >= model_.junction_count();
  const int tank = at_from ? from : to;
  const double outflow = at_from ? state.flow_m3_s[link] : -state.flow_m3_s[link];
  if (tank < model_.first_tank() || !IsBlocked(state, link, tank, at_from ? to : from, outflow)) {
    return state.status[link];
  }
  return LinkStatus::kTemporarilyClosed;
}

LinkStatus StatusRules::FindStatus(const HydraulicState& state, int link) const {
  const LinkStatus before = state.status[link];
  const bool may_reopen = before == LinkStatus::kPumpTooWeak || before == LinkStatus::kTemporarilyClosed;
  const LinkStatus status = may_reopen ? LinkStatus::kOpen : before;
  const double drop = state.head_m[model_.From(link)] - state.head_m[model_.To(link)];
  const double setting = state.setting[link];
  if (IsCheckValve(model_, link)) return FindCheckValve(status, drop, state.flow_m3_s[link]);
  if (IsPump(model_, link) && !IsClosed(status) && setting > 0) {
    const double highest = laws_.ShutoffHead_m(link - model_.first_pump(), setting);
    return -drop > highest + head_tolerance_m_ ? LinkStatus::kPumpTooWeak : LinkStatus::kOpen;
  }
  if (IsFlowControl(model_, link) && !std::isnan(setting)) return FindFlowControl(state, link, before);
  return status;
}

bool StatusRules::UpdateLinks(HydraulicState& state) const {
  bool changed = false;
  for (const int link : watched_) {
    const LinkStatus before = state.status[link];
    state.status[link] = FindStatus(state, link);
    if (!IsClosed(state.status[link])) state.status[link] = FindAtTank(state, link);
    changed = changed || state.status[link] != before;
  }
  return changed;
}

bool StatusRules::UpdatePressureControls(HydraulicState& state) const {
  bool changed = false;
  for (const SimpleControl& control : model_.controls) {
    if (!control.enabled || control.node < 0 || control.node >= model_.junction_count()) continue;
    const double head = state.head_m[control.node];
    const bool is_low =
        control.when == SimpleControl::When::kBelow && head <= control.head_m + head_tolerance_m_;
    const bool is_high =
        control.when == SimpleControl::When::kAbove && head >= control.head_m - head_tolerance_m_;
    if (is_low || is_high) changed = ApplyPressureControl(control.action, model_, state) || changed;
  }
  return changed;
}

}  // namespace piperun::sim
