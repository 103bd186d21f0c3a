#pragma once

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "sim/network/head_system.h"
#include "sim/network/hydraulic_state.h"
#include "sim/network/junction_outflow.h"
#include "sim/network/link_law.h"
#include "sim/network/link_status.h"
#include "sim/network/model.h"

namespace piperun::sim {

/// Solves the steady flow of a network by the global gradient algorithm (Todini & Pilati, in Computer
/// Applications in Water Supply 1, 1988): Newton's method on
///   H_from - H_to = h(Q) for every link,  sum Q_in - sum Q_out = demand + outlets(H) for every junction,
/// with the flows eliminated, so that each iteration solves one sparse symmetric system for the heads.
/// Iterations, status checks and stopping follow EPANET, so that the iteration count is EPANET's; where a
/// control valve leaves mass unbalanced, up to two further iterations balance it.
///
/// The topology is analysed once, in the constructor; Solve may be called any number of times, each time from
/// where the state stands (warm). Not safe for two threads at a time: one solver per thread.
class HydraulicSolver {
 public:
  /// `model` must outlive the solver and keep its topology.
  explicit HydraulicSolver(const HydraulicModel& model);

  /// Settings, levels and demands of the model at time 0, and EPANET's first guess of the flows.
  HydraulicState MakeState() const;

  /// Finds heads, flows and statuses for the demands, fixed heads and settings of the state. Failing to
  /// converge is a value: the report names the worst link and by how much it fails; the state then holds the
  /// last iterate.
  SolveReport Solve(HydraulicState& state);

  /// Puts the greatest head error of a state into a report: how far heads and the law of each link's flow
  /// disagree. Solve does it by itself only when it fails: it costs a fifth of an iteration.
  void FindHeadError(const HydraulicState& state, SolveReport& report);

  /// Gives the leaks of a junction (its own and its pipes' shares together) new coefficients, and their flow
  /// a first guess at the head of the state.
  void SetLeak(int junction, const LeakCoefficients& leak, HydraulicState& state);

  const HydraulicModel& model() const { return model_; }
  const LinkLaws& laws() const { return laws_; }

 private:
  struct FlowChange {
    double changed_m3_s = 0;
    double total_m3_s = 0;
    double greatest_m3_s = 0;
    /// Adds a relaxed step to a flow.
    void Apply(double step_m3_s, double& flow_m3_s) {
      flow_m3_s += step_m3_s;
      total_m3_s += std::abs(flow_m3_s);
      changed_m3_s += std::abs(step_m3_s);
      greatest_m3_s = std::max(greatest_m3_s, std::abs(step_m3_s));
    }
  };

  void Assemble(const HydraulicState& state);
  void AssembleLinks(const HydraulicState& state);
  void AssembleFlowControl(const HydraulicState& state, int link);
  void AssemblePinned(const HydraulicState& state, int link);
  /// A link that follows its law: q = q0 + (drop - h(q0)) / h'(q0) if no head changes.
  void AssembleLawful(const HydraulicState& state, int link) {
    const double conductance = 1 / losses_[link].slope_s_m2;
    const double drop = state.head_m[ends_[link].first] - state.head_m[ends_[link].second];
    PredictLink(link, state.flow_m3_s[link] + conductance * (drop - losses_[link].loss_m), conductance);
  }
  void AssembleOutlets(const HydraulicState& state);
  /// How far a link's flow has to go after the last solution for the heads.
  double CalcStep_m3_s(const HydraulicState& state, int link, double relaxation) const {
    const double goal = predicted_m3_s_[link] + conductance_m2_s_[link] * system_.Difference(link);
    return relaxation * (goal - state.flow_m3_s[link]);
  }
  /// A link's part in the equations: its flow if no head changed, q - h/h' + dH/h', and how it follows heads.
  void PredictLink(int link, double flow_m3_s, double conductance) {
    predicted_m3_s_[link] = flow_m3_s;
    conductance_m2_s_[link] = conductance;
    system_.AddLink(link, conductance, flow_m3_s);
  }
  void CalcExcess(const HydraulicState& state);
  bool IsControlled(const HydraulicState& state, int link) const;
  bool IsPinned(const HydraulicState& state, int link) const;
  bool HasPinned(const HydraulicState& state) const;
  bool IsIdle(const Outlet& outlet, const HydraulicState& state) const;
  bool HandOverValve(HydraulicState& state) const;

  FlowChange UpdateFlows(HydraulicState& state, double relaxation);
  double LimitStep(int link, double flow_m3_s, double step_m3_s) const;
  void UpdateOutletFlow(HydraulicState& state, std::size_t outlet, double relaxation, FlowChange& change);
  bool Iterate(HydraulicState& state, double relaxation, SolveReport& report, FlowChange& change);
  bool IsConverged(const HydraulicState& state, const SolveReport& report, const FlowChange& change);
  bool OutletsConverged(const HydraulicState& state) const;
  double PinnedFlow_m3_s(int link) const;
  void SettleFlows(HydraulicState& state);
  void Balance(HydraulicState& state, SolveReport& report);
  bool UpdateStatuses(HydraulicState& state) const;
  void Finish(HydraulicState& state, SolveReport& report);
  void FindImbalance(const HydraulicState& state, SolveReport& report);
  void CalcInflows(HydraulicState& state) const;

  const HydraulicModel& model_;
  const int junction_count_, first_pump_, first_valve_, link_count_;  // the model's, asked for too often
  LinkLaws laws_;
  StatusRules statuses_;
  std::vector<Outlet> outlets_;
  std::vector<std::pair<int, int>> ends_;
  HeadSystem system_;
  std::vector<HeadLoss> losses_;          // per link
  std::vector<double> predicted_m3_s_;    // per link: its flow if no head changed
  std::vector<double> conductance_m2_s_;  // per link: dq / d(head difference)
  std::vector<double> outlet_predicted_m3_s_;
  std::vector<double> outlet_conductance_m2_s_;
  std::vector<double> excess_m3_s_;  // per node
};

}  // namespace piperun::sim
