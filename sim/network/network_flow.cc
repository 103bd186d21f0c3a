#include "sim/network/network_flow.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "base/check.h"
#include "base/number.h"
#include "sim/pipe_flow.h"

namespace piperun::sim {
namespace {

constexpr double kMaxRelativeRoughness = 0.05;  // the end of Moody's chart

/// The instants around a time of the period, and how far it lies from the first to the second.
struct Bracket {
  std::size_t before = 0;
  std::size_t after = 0;
  double share = 0;
};

Bracket FindBracket(std::span<const HydraulicStep> steps, double time_s) {
  std::size_t after = 0;
  while (after < steps.size() && static_cast<double>(steps[after].time_s) <= time_s) ++after;
  if (after == 0) return {0, 0, 0};
  if (after == steps.size()) return {after - 1, after - 1, 0};
  const auto begin = static_cast<double>(steps[after - 1].time_s);
  const double length = static_cast<double>(steps[after].time_s) - begin;
  return {after - 1, after, (time_s - begin) / length};
}

double Lerp(double a, double b, double share) { return a + share * (b - a); }

/// Flow and heads of a network at one time, between two instants.
class Moment {
 public:
  Moment(std::span<const HydraulicStep> steps, double time_s) {
    const Bracket at = FindBracket(steps, time_s);
    before_ = &steps[at.before].state;
    after_ = &steps[at.after].state;
    share_ = at.share;
  }

  double Flow_m3_s(int link) const { return Mean(before_->flow_m3_s, after_->flow_m3_s, link); }
  double Head_m(int node) const { return Mean(before_->head_m, after_->head_m, node); }
  double LeakFlow_m3_s(int junction) const {
    return Mean(before_->fixed_leak_m3_s, after_->fixed_leak_m3_s, junction) +
           Mean(before_->variable_leak_m3_s, after_->variable_leak_m3_s, junction);
  }

 private:
  double Mean(const std::vector<double>& a, const std::vector<double>& b, int i) const {
    return Lerp(a[static_cast<std::size_t>(i)], b[static_cast<std::size_t>(i)], share_);
  }

  const HydraulicState* before_;
  const HydraulicState* after_;
  double share_;
};

/// Where the reaches of every link lie, and which links of the cut model they are.
std::vector<std::vector<PipePiece>> FindReaches(const LeakyModel& leaky, const Network& network) {
  std::vector<std::vector<PipePiece>> reaches = leaky.pipes;
  for (int link = leaky.model.first_pump(); link < leaky.model.link_count(); ++link) {
    reaches.push_back({{link, 0, 0}});
  }
  Demand(reaches.size() == network.pipes().size(), "a network has a pipe for every link of its model");
  for (std::size_t i = 0; i < reaches.size(); ++i) reaches[i].back().s_end_m = network.pipes()[i].length_m;
  return reaches;
}

FrictionLaw MakeFrictionLaw(const Network& network, const WaterProperties& water) {
  FrictionLaw law;
  law.kinematic_viscosity_m2_s = water.kinematic_viscosity_m2_s;
  for (const Pipe& pipe : network.pipes()) {
    const double relative = pipe.material.roughness_m / pipe.diameter_m;
    if (!(relative >= 0 && relative <= kMaxRelativeRoughness)) {
      throw InputError("pipe '" + pipe.id + "' has a roughness of " +
                           FormatNumber(pipe.material.roughness_m) +
                           " m; friction is known up to 0.05 diameters, " +
                           FormatNumber(kMaxRelativeRoughness * pipe.diameter_m) + " m",
                       "network.pipes");
    }
    law.relative_roughness.push_back(relative);
  }
  return law;
}

FlowReach MakeReach(const HydraulicModel& model, const PipePiece& piece, const Moment& moment,
                    const Pipe& pipe, const FrictionLaw& law, double relative_roughness) {
  FlowReach reach{piece.s_begin_m,
                  piece.s_end_m,
                  moment.Flow_m3_s(piece.link),
                  moment.Head_m(model.From(piece.link)),
                  moment.Head_m(model.To(piece.link)),
                  0};
  const double speed_m_s = std::abs(reach.flow_m3_s) / pipe.area_m2();
  reach.friction_factor =
      CalcFrictionFactor(speed_m_s * pipe.diameter_m / law.kinematic_viscosity_m2_s, relative_roughness);
  return reach;
}

/// The launch itself and the instants after it.
std::vector<std::int64_t> FindTimes(std::span<const HydraulicStep> steps, std::int64_t launch_s) {
  if (steps.empty()) throw InputError("the hydraulics have no instant", "network");
  if (launch_s < steps.front().time_s || launch_s > steps.back().time_s) {
    throw InputError("the launch is at " + std::to_string(launch_s) + " s of the period; allowed: [" +
                         std::to_string(steps.front().time_s) + ", " + std::to_string(steps.back().time_s) +
                         "] s, as far as the hydraulics go",
                     "flow.launch_time_s");
  }
  std::vector<std::int64_t> times{launch_s};
  for (const HydraulicStep& step : steps) {
    if (step.time_s > times.back()) times.push_back(step.time_s);
  }
  return times;
}

}  // namespace

FlowTimeline MakeFlowTimeline(const LeakyModel& leaky, std::span<const HydraulicStep> steps,
                              std::int64_t launch_s, const Network& network, const WaterProperties& water) {
  const std::vector<std::vector<PipePiece>> pieces = FindReaches(leaky, network);
  FrictionLaw law = MakeFrictionLaw(network, water);
  std::vector<double> areas_m2;
  for (const Pipe& pipe : network.pipes()) areas_m2.push_back(pipe.area_m2());
  std::vector<TrueTime> times;
  std::vector<FlowState> states;
  for (const std::int64_t time_s : FindTimes(steps, launch_s)) {
    const Moment moment(steps, static_cast<double>(time_s));
    FlowState state;
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      std::vector<FlowReach>& reaches = state.pipes.emplace_back();
      for (const PipePiece& piece : pieces[i]) {
        reaches.push_back(
            MakeReach(leaky.model, piece, moment, network.pipes()[i], law, law.relative_roughness[i]));
      }
    }
    times.push_back(TrueTime(std::chrono::seconds(time_s - launch_s)));
    states.push_back(std::move(state));
  }
  return FlowTimeline(std::move(areas_m2), std::move(times), std::move(states), std::move(law));
}

std::vector<LeakState> CalcLeakStates(const LeakyModel& leaky, std::span<const HydraulicStep> steps,
                                      std::int64_t launch_s, TrueTime t, const WaterProperties& water,
                                      double gravity_m_s2) {
  Demand(!steps.empty(), "the hydraulics have an instant");
  const Moment moment(steps, static_cast<double>(launch_s) + Seconds(t));
  std::vector<LeakState> leaks;
  for (const LeakPlace& place : leaky.leaks) {
    const double pressure_head_m = moment.Head_m(place.junction) - leaky.model.Elevation_m(place.junction);
    leaks.push_back(
        {moment.LeakFlow_m3_s(place.junction), water.density_kg_m3 * gravity_m_s2 * pressure_head_m});
  }
  return leaks;
}

}  // namespace piperun::sim
