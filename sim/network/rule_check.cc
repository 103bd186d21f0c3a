#include "sim/network/rule_check.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <vector>

#include "sim/network/link_action.h"
#include "sim/network/tank.h"

namespace piperun::sim {
namespace {

using Quantity = RulePremise::Quantity;
using Relation = RulePremise::Relation;

constexpr std::int64_t kDay_s = 86400;
constexpr double kStillTank_m3_s = 1e-6 * 0.3048 * 0.3048 * 0.3048;  // EPANET: 1e-6 ft3/s

bool HoldsTime(const RulePremise& premise, const RuleContext& context) {
  std::int64_t begin = context.begin_s, now = context.now_s;
  if (premise.quantity == Quantity::kClockTime) {
    begin = (begin + context.model.times.start_clock_s) % kDay_s;
    now = (now + context.model.times.start_clock_s) % kDay_s;
  }
  const auto goal = static_cast<std::int64_t>(premise.value);
  const bool passed = now < begin ? goal >= begin || goal <= now : goal >= begin && goal <= now;
  switch (premise.relation) {
    case Relation::kEqual:
      return passed;
    case Relation::kNotEqual:
      return !passed;
    case Relation::kLess:
      return now < goal;
    case Relation::kLessOrEqual:
      return now <= goal;
    case Relation::kGreater:
      return now > goal;
    case Relation::kGreaterOrEqual:
      return now >= goal;
  }
  return false;
}

bool HoldsStatus(const RulePremise& premise, const RuleContext& context) {
  const LinkStatus status = context.state.status[premise.index];
  const auto coarse = [](LinkStatus s) {
    if (IsClosed(s)) return LinkStatus::kClosed;
    return s == LinkStatus::kActive ? s : LinkStatus::kOpen;
  };
  const bool same = coarse(status) == coarse(premise.status);
  return premise.relation == Relation::kEqual ? same : premise.relation == Relation::kNotEqual && !same;
}

/// Wanted by all customers together.
double SystemDemand_m3_s(const HydraulicState& state) {
  return std::accumulate(state.demand_m3_s.begin(), state.demand_m3_s.end(), 0.0,
                         [](double sum, double demand) { return sum + std::max(0.0, demand); });
}

/// Seconds until a tank is full (or empty); nothing when it does not fill (empty).
std::optional<double> TimeToLimit_s(const RuleContext& context, int node, bool filling) {
  const auto tank = static_cast<std::size_t>(node - context.model.first_tank());
  const TankNode& spec = context.model.tanks[tank];
  const double inflow = context.state.inflow_m3_s[node - context.model.junction_count()];
  if (filling ? inflow <= kStillTank_m3_s : inflow >= -kStillTank_m3_s) return std::nullopt;
  const double goal = filling ? MaxTankVolume_m3(spec) : MinTankVolume_m3(spec);
  return (goal - context.tank_volume_m3[tank]) / inflow;
}

double NodeDemand_m3_s(const RuleContext& context, int node) {
  const int fixed = node - context.model.junction_count();
  return fixed < 0 ? context.state.Outflow_m3_s(node) : context.state.inflow_m3_s[fixed];
}

std::optional<double> FindValue(const RulePremise& premise, const RuleContext& context) {
  const HydraulicState& state = context.state;
  const int i = premise.index;
  switch (premise.quantity) {
    case Quantity::kDemand:
      return i < 0 ? SystemDemand_m3_s(state) : NodeDemand_m3_s(context, i);
    case Quantity::kHead:
      return state.head_m[i];
    case Quantity::kPressure:
    case Quantity::kLevel:
      return state.head_m[i] - context.model.Elevation_m(i);
    case Quantity::kFlow:
      return std::abs(state.flow_m3_s[i]);
    case Quantity::kSetting:
      return std::isnan(state.setting[i]) ? std::nullopt : std::optional(state.setting[i]);
    case Quantity::kFillTime:
      return TimeToLimit_s(context, i, true);
    case Quantity::kDrainTime:
      return TimeToLimit_s(context, i, false);
    default:
      return std::nullopt;
  }
}

/// EPANET's tolerances: `<` and `>` let the value come 0.001 beyond, `<=` and `>=` ask for 0.001 more.
bool HoldsValue(const RulePremise& premise, const RuleContext& context) {
  const std::optional<double> value = FindValue(premise, context);
  if (!value) return false;
  const double x = *value, goal = premise.value, tolerance = premise.tolerance;
  switch (premise.relation) {
    case Relation::kEqual:
      return std::abs(x - goal) <= tolerance;
    case Relation::kNotEqual:
      return std::abs(x - goal) >= tolerance;
    case Relation::kLess:
      return x <= goal + tolerance;
    case Relation::kLessOrEqual:
      return x <= goal - tolerance;
    case Relation::kGreater:
      return x >= goal - tolerance;
    case Relation::kGreaterOrEqual:
      return x >= goal + tolerance;
  }
  return false;
}

bool Holds(const RulePremise& premise, const RuleContext& context) {
  if (premise.quantity == Quantity::kTime || premise.quantity == Quantity::kClockTime) {
    return HoldsTime(premise, context);
  }
  return premise.quantity == Quantity::kStatus ? HoldsStatus(premise, context) : HoldsValue(premise, context);
}

struct Pending {
  const LinkAction* action;
  double priority;
};

void Add(const std::vector<LinkAction>& actions, double priority, std::vector<Pending>& pending) {
  for (const LinkAction& action : actions) {
    const auto found = std::find_if(pending.begin(), pending.end(),
                                    [&](const Pending& p) { return p.action->link == action.link; });
    if (found == pending.end()) {
      pending.push_back({&action, priority});
    } else if (priority > found->priority) {
      *found = {&action, priority};
    }
  }
}

}  // namespace

bool HoldsRule(const Rule& rule, const RuleContext& context) {
  bool result = true;
  for (const RulePremise& premise : rule.premises) {
    if (premise.is_alternative) {
      result = result || Holds(premise, context);
    } else if (!result) {
      return false;
    } else {
      result = Holds(premise, context);
    }
  }
  return result;
}

bool FireRules(const RuleContext& context, const LinkLaws& laws, HydraulicState& state) {
  std::vector<Pending> pending;
  for (const Rule& rule : context.model.rules) {
    Add(HoldsRule(rule, context) ? rule.then_actions : rule.else_actions, rule.priority, pending);
  }
  bool changed = false;
  for (const Pending& p : pending) changed = ApplyRule(*p.action, context.model, laws, state) || changed;
  return changed;
}

}  // namespace piperun::sim
