#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "sim/network/hydraulic_state.h"
#include "sim/network/model.h"
#include "sim/network/solver.h"

namespace piperun::sim {

/// One instant of an extended period.
struct HydraulicStep {
  std::int64_t time_s = 0;
  bool reported = false;  ///< a multiple of the report step (from its start), or the end
  SolveReport report;
  HydraulicState state;
};

/// The hydraulics of a day, instant after instant: demands follow patterns, tanks fill and empty by Euler's
/// rule between instants, simple controls and rules switch links. Instants are whole seconds: the hydraulic
/// step, cut where a pattern, a report, a tank (full or empty) or a control asks for it, and where a rule
/// fires.
///
/// while (Advance()) ...; or Solve once for time 0 only.
class HydraulicSimulation {
 public:
  /// `model` must outlive the simulation and not change.
  explicit HydraulicSimulation(const HydraulicModel& model);

  /// Imposes demands, heads and controls of the present time, and solves.
  const SolveReport& Solve();
  /// Goes on to the next instant: tank levels, rules, clock. False when the duration is over (or, with
  /// UNBALANCED STOP, when the last instant did not converge).
  bool Advance();

  std::int64_t time_s() const { return time_s_; }
  bool IsReportTime() const;
  const HydraulicState& state() const { return state_; }
  HydraulicState& state() { return state_; }
  const SolveReport& report() const { return report_; }
  double TankVolume_m3(int tank) const { return volume_m3_[tank]; }
  HydraulicSolver& solver() { return solver_; }

 private:
  void ImposeDemands();
  void ImposeControls();
  bool IsDue(const SimpleControl& control) const;
  void FindMultipliers();
  double Multiplier(int pattern) const { return pattern < 0 ? 1 : multipliers_[pattern]; }

  std::int64_t NextStep_s() const;
  void CutAtTanks(std::int64_t& step_s) const;
  void CutAtControls(std::int64_t& step_s) const;
  std::int64_t TimeToControl_s(const SimpleControl& control) const;
  std::int64_t StepThroughRules(std::int64_t step_s);
  void FillTanks(std::int64_t step_s);

  const HydraulicModel& model_;
  HydraulicSolver solver_;
  HydraulicState state_;
  SolveReport report_;
  std::vector<double> volume_m3_;    // per tank
  std::vector<double> multipliers_;  // per pattern, at this instant
  std::int64_t time_s_ = 0;
  std::int64_t next_report_s_ = 0;
};

/// Runs the whole period and hands over every instant. Returns how many there were.
int SimulatePeriod(const HydraulicModel& model, const std::function<void(const HydraulicStep&)>& on_step);

}  // namespace piperun::sim
