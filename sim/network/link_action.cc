#include "sim/network/link_action.h"

#include <cmath>
#include <limits>

#include "sim/network/epanet_constants.h"

namespace piperun::sim {
namespace {

constexpr double kNoSetting = std::numeric_limits<double>::quiet_NaN();
constexpr double kSettingTolerance = 1e-3;  // of EPANET's internal units

bool IsPump(const HydraulicModel& model, int link) {
  return link >= model.first_pump() && link < model.first_valve();
}

bool SameSetting(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }

/// A constant-power pump that starts again starts from its first guess: at no flow it has no law.
void RestartFlow(int link, const HydraulicModel& model, const LinkLaws& laws, HydraulicState& state) {
  const int pump = link - model.first_pump();
  if (laws.IsConstantPower(pump)) state.flow_m3_s[link] = laws.FirstPumpFlow_m3_s(pump);
}

struct Target {
  LinkStatus status;
  double setting;
};

Target FindTarget(const LinkAction& action, const HydraulicModel& model) {
  if (action.link < model.first_pump()) return {*action.status, kNoSetting};
  if (IsPump(model, action.link)) {
    const double speed = action.setting.value_or(action.status == LinkStatus::kOpen ? 1 : 0);
    return {speed > 0 ? LinkStatus::kOpen : LinkStatus::kClosed, speed};
  }
  if (action.status) return {*action.status, kNoSetting};
  return {LinkStatus::kActive, *action.setting};
}

/// What counts as the same setting, in the unit of the link's setting.
double SettingTolerance(int link, const HydraulicModel& model) {
  if (link < model.first_valve()) return kSettingTolerance;
  switch (model.valves[link - model.first_valve()].kind) {
    case ValveKind::kFlowControl:
      return kSettingTolerance * epanet::kCubicFoot_m3;
    case ValveKind::kPressureReducing:
    case ValveKind::kPressureSustaining:
    case ValveKind::kPressureBreaker:
      return kSettingTolerance * epanet::kFoot_m;
    default:
      return kSettingTolerance;
  }
}

void ApplyStatus(int link, LinkStatus status, const HydraulicModel& model, const LinkLaws& laws,
                 HydraulicState& state) {
  if (IsPump(model, link)) {
    const bool starts = status == LinkStatus::kOpen && state.status[link] == LinkStatus::kClosed;
    if (starts) RestartFlow(link, model, laws, state);
    state.setting[link] = status == LinkStatus::kOpen ? 1 : 0;
  } else if (link >= model.first_valve()) {
    state.setting[link] = kNoSetting;
  }
  state.status[link] = status;
}

}  // namespace

bool ApplyControl(const LinkAction& action, const HydraulicModel& model, const LinkLaws& laws,
                  HydraulicState& state) {
  const int link = action.link;
  const Target target = FindTarget(action, model);
  const LinkStatus now = IsClosed(state.status[link]) ? LinkStatus::kClosed : LinkStatus::kOpen;
  const bool is_pipe = link < model.first_pump();
  if (now == target.status && (is_pipe || SameSetting(state.setting[link], target.setting))) return false;
  if (IsPump(model, link) && now == LinkStatus::kClosed && target.status == LinkStatus::kOpen) {
    RestartFlow(link, model, laws, state);
  }
  state.status[link] = target.status;
  if (!is_pipe) state.setting[link] = target.setting;
  return true;
}

bool IsInEffect(const LinkAction& action, const HydraulicModel& model, const HydraulicState& state) {
  const Target target = FindTarget(action, model);
  const bool is_pipe = action.link < model.first_pump();
  return (is_pipe || SameSetting(state.setting[action.link], target.setting)) &&
         state.status[action.link] == target.status;
}

bool ApplyPressureControl(const LinkAction& action, const HydraulicModel& model, HydraulicState& state) {
  const int link = action.link;
  const Target target = FindTarget(action, model);
  const bool is_pipe = link < model.first_pump();
  const bool by_status = is_pipe || (link >= model.first_valve() && std::isnan(target.setting));
  const bool same = (is_pipe || SameSetting(state.setting[link], target.setting)) &&
                    (!by_status || state.status[link] == target.status);
  if (same) return false;
  state.status[link] = target.status;
  if (!is_pipe) state.setting[link] = target.setting;
  return true;
}

bool ApplyRule(const LinkAction& action, const HydraulicModel& model, const LinkLaws& laws,
               HydraulicState& state) {
  const int link = action.link;
  if (action.status) {
    if (IsClosed(*action.status) == IsClosed(state.status[link])) return false;
    ApplyStatus(link, *action.status, model, laws, state);
    return true;
  }
  if (std::abs(*action.setting - state.setting[link]) <= SettingTolerance(link, model)) return false;
  ApplySetting(link, *action.setting, model, laws, state);
  return true;
}

void ApplySetting(int link, double setting, const HydraulicModel& model, const LinkLaws& laws,
                  HydraulicState& state) {
  LinkStatus& status = state.status[link];
  if (IsPump(model, link)) {
    if (setting > 0 && IsClosed(status)) {
      RestartFlow(link, model, laws, state);
      status = LinkStatus::kOpen;
    } else if (setting == 0 && !IsClosed(status)) {
      status = LinkStatus::kClosed;
    }
  } else if (model.valves[link - model.first_valve()].kind == ValveKind::kFlowControl) {
    status = LinkStatus::kActive;
  } else if (std::isnan(state.setting[link]) && IsClosed(status)) {
    status = LinkStatus::kOpen;
  }
  state.setting[link] = setting;
}

}  // namespace piperun::sim
