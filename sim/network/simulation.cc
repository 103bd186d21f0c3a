#include "sim/network/simulation.h"

#include <algorithm>
#include <cmath>

#include "sim/network/epanet_constants.h"
#include "sim/network/link_action.h"
#include "sim/network/rule_check.h"
#include "sim/network/tank.h"

namespace piperun::sim {
namespace {

constexpr std::int64_t kDay_s = 86400;

/// Shortens a step to a time that lies ahead.
void CutAt(std::int64_t ahead_s, std::int64_t& step_s) {
  if (ahead_s > 0 && ahead_s < step_s) step_s = ahead_s;
}

std::int64_t RoundSeconds(double seconds) {
  constexpr double kMost = 1e15;
  return std::abs(seconds) < kMost ? std::llround(seconds) : 0;
}

}  // namespace

HydraulicSimulation::HydraulicSimulation(const HydraulicModel& model)
    : model_(model),
      solver_(model),
      state_(solver_.MakeState()),
      multipliers_(model.patterns.size()),
      next_report_s_(model.times.report_step_s) {
  for (const TankNode& tank : model.tanks)
    volume_m3_.push_back(CalcTankVolume_m3(tank, tank.initial_level_m));
}

void HydraulicSimulation::FindMultipliers() {
  const std::int64_t period = (time_s_ + model_.times.pattern_start_s) / model_.times.pattern_step_s;
  for (std::size_t i = 0; i < multipliers_.size(); ++i) {
    const std::vector<double>& all = model_.patterns[i].multipliers;
    multipliers_[i] = all[static_cast<std::size_t>(period) % all.size()];
  }
}

void HydraulicSimulation::ImposeDemands() {
  FindMultipliers();
  for (int i = 0; i < model_.junction_count(); ++i) {
    double demand = 0;
    for (const DemandCategory& category : model_.junctions[i].demands) {
      demand += category.base_m3_s * Multiplier(category.pattern) * model_.options.demand_multiplier;
    }
    state_.demand_m3_s[i] = state_.delivered_m3_s[i] = demand;
  }
  for (int i = 0; i < model_.reservoir_count(); ++i) {
    const ReservoirNode& reservoir = model_.reservoirs[i];
    state_.head_m[model_.junction_count() + i] = reservoir.head_m * Multiplier(reservoir.pattern);
  }
  for (std::size_t i = 0; i < model_.pumps.size(); ++i) {
    const int pattern = model_.pumps[i].pattern, link = model_.first_pump() + static_cast<int>(i);
    if (pattern >= 0) ApplySetting(link, Multiplier(pattern), model_, solver_.laws(), state_);
  }
}

/// A control on a tank acts within a second's flow of its level.
bool HydraulicSimulation::IsDue(const SimpleControl& control) const {
  if (control.when == SimpleControl::When::kTime) return control.time_s == time_s_;
  if (control.when == SimpleControl::When::kClockTime) {
    return (time_s_ + model_.times.start_clock_s) % kDay_s == control.time_s;
  }
  if (control.node < model_.junction_count()) return false;
  const double slack = std::abs(state_.inflow_m3_s[control.node - model_.junction_count()]);
  const double head = state_.head_m[control.node];
  double value = head, goal = control.head_m, tolerance = 0;
  if (control.node >= model_.first_tank()) {
    const TankNode& tank = model_.tanks[control.node - model_.first_tank()];
    value = CalcTankVolume_m3(tank, head - tank.elevation_m);
    goal = CalcTankVolume_m3(tank, control.head_m - tank.elevation_m);
    tolerance = slack;
  }
  return control.when == SimpleControl::When::kBelow ? value <= goal + tolerance : value >= goal - tolerance;
}

void HydraulicSimulation::ImposeControls() {
  for (const SimpleControl& control : model_.controls) {
    if (control.enabled && IsDue(control)) ApplyControl(control.action, model_, solver_.laws(), state_);
  }
}

const SolveReport& HydraulicSimulation::Solve() {
  ImposeDemands();
  ImposeControls();
  return report_ = solver_.Solve(state_);
}

void HydraulicSimulation::CutAtTanks(std::int64_t& step_s) const {
  for (std::size_t i = 0; i < model_.tanks.size(); ++i) {
    const TankNode& tank = model_.tanks[i];
    const int node = model_.first_tank() + static_cast<int>(i);
    const double level = state_.head_m[node] - tank.elevation_m;
    const double inflow = state_.inflow_m3_s[node - model_.junction_count()];
    if (std::abs(inflow) <= epanet::kZeroFlow_m3_s) continue;
    if (inflow > 0 && level < tank.max_level_m) {
      CutAt(RoundSeconds((MaxTankVolume_m3(tank) - volume_m3_[i]) / inflow), step_s);
    } else if (inflow < 0 && level > tank.min_level_m) {
      CutAt(RoundSeconds((MinTankVolume_m3(tank) - volume_m3_[i]) / inflow), step_s);
    }
  }
}

std::int64_t HydraulicSimulation::TimeToControl_s(const SimpleControl& control) const {
  if (control.when == SimpleControl::When::kTime) return control.time_s - time_s_;
  if (control.when == SimpleControl::When::kClockTime) {
    const std::int64_t clock = (time_s_ + model_.times.start_clock_s) % kDay_s;
    return (control.time_s - clock + kDay_s) % kDay_s;
  }
  if (control.node < model_.first_tank()) return 0;
  const double head = state_.head_m[control.node];
  const double inflow = state_.inflow_m3_s[control.node - model_.junction_count()];
  const bool rising = control.when == SimpleControl::When::kAbove && head < control.head_m && inflow > 0;
  const bool falling = control.when == SimpleControl::When::kBelow && head > control.head_m && inflow < 0;
  if (std::abs(inflow) <= epanet::kZeroFlow_m3_s || (!rising && !falling)) return 0;
  const auto i = static_cast<std::size_t>(control.node - model_.first_tank());
  const TankNode& tank = model_.tanks[i];
  return RoundSeconds((CalcTankVolume_m3(tank, control.head_m - tank.elevation_m) - volume_m3_[i]) / inflow);
}

/// Only a control that changes something cuts a step.
void HydraulicSimulation::CutAtControls(std::int64_t& step_s) const {
  for (const SimpleControl& control : model_.controls) {
    if (!control.enabled) continue;
    const std::int64_t ahead = TimeToControl_s(control);
    if (ahead > 0 && ahead < step_s && !IsInEffect(control.action, model_, state_)) step_s = ahead;
  }
}

std::int64_t HydraulicSimulation::NextStep_s() const {
  const HydraulicTimes& times = model_.times;
  std::int64_t step = times.hydraulic_step_s;
  const std::int64_t period = (time_s_ + times.pattern_start_s) / times.pattern_step_s + 1;
  CutAt(period * times.pattern_step_s - time_s_, step);
  CutAt(next_report_s_ - time_s_, step);
  CutAtTanks(step);
  CutAtControls(step);
  return step;
}

/// Fills tanks in rule steps and looks at the rules after each. Returns the step up to the first that fires.
std::int64_t HydraulicSimulation::StepThroughRules(std::int64_t step_s) {
  const std::int64_t begin = time_s_, end = time_s_ + step_s, rule_step = model_.times.rule_step_s;
  std::int64_t now = begin;
  std::int64_t part = std::min(rule_step - begin % rule_step, step_s);
  while (part > 0) {
    now += part;
    FillTanks(part);
    const RuleContext context{model_, state_, volume_m3_, now - part + 1, now};
    if (FireRules(context, solver_.laws(), state_)) break;
    part = std::min({rule_step, step_s, end - now});
  }
  return now - begin;
}

/// V += Q dt; a tank that a second would fill is full, one that is drawn below its minimum is empty. EPANET's
/// rule: within half a second's flow of its minimum a tank keeps the level it has.
void HydraulicSimulation::FillTanks(std::int64_t step_s) {
  for (std::size_t i = 0; i < model_.tanks.size(); ++i) {
    const TankNode& tank = model_.tanks[i];
    const int node = model_.first_tank() + static_cast<int>(i);
    const double inflow = state_.inflow_m3_s[node - model_.junction_count()];
    if (inflow == 0) continue;
    const double volume = volume_m3_[i] + inflow * static_cast<double>(step_s);
    double level = 0;
    if (volume + inflow >= MaxTankVolume_m3(tank)) {
      volume_m3_[i] = MaxTankVolume_m3(tank);
      level = tank.max_level_m;
    } else if (volume - inflow <= MinTankVolume_m3(tank)) {
      volume_m3_[i] = MinTankVolume_m3(tank);
      level = tank.min_level_m;
    } else {
      volume_m3_[i] = volume;
      level = CalcTankLevel_m(tank, volume);
    }
    state_.head_m[node] = tank.elevation_m + level;
  }
}

bool HydraulicSimulation::IsReportTime() const {
  const HydraulicTimes& times = model_.times;
  if (time_s_ >= times.duration_s) return true;
  return time_s_ >= times.report_start_s && (time_s_ - times.report_start_s) % times.report_step_s == 0;
}

bool HydraulicSimulation::Advance() {
  const bool stop = !report_.converged() && model_.options.extra_trials < 0;
  if (stop || time_s_ >= model_.times.duration_s) return false;
  std::int64_t step = NextStep_s();
  if (model_.rules.empty()) {
    FillTanks(step);
  } else {
    step = StepThroughRules(step);
  }
  time_s_ += step;
  if (time_s_ >= next_report_s_) next_report_s_ += model_.times.report_step_s;
  return true;
}

int SimulatePeriod(const HydraulicModel& model, const std::function<void(const HydraulicStep&)>& on_step) {
  HydraulicSimulation simulation(model);
  int count = 0;
  do {
    simulation.Solve();
    on_step({simulation.time_s(), simulation.IsReportTime(), simulation.report(), simulation.state()});
    ++count;
  } while (simulation.Advance());
  return count;
}

}  // namespace piperun::sim
