// Balls in networks: none gets out through a wall, and water decides where they turn.

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

#include "base/check.h"
#include "base/number.h"
#include "scenarios/assemble.h"
#include "scenarios/parallel.h"
#include "scenarios/random_network.h"
#include "scenarios/reproduction.h"

namespace piperun::scenarios {
namespace {

constexpr int kNetworks = 10000;
constexpr int kTurnsInY = 2000;
constexpr int kTurnsPerShare = 400;
constexpr std::array kShares{0.05, 0.15, 0.3, 0.5, 0.7, 0.85, 0.95};
constexpr double kOverlap_m = 2e-5;  // (v dt)^2 / (2 r): by so much a step of 1 mm leaves a sphere of 30 mm

int Sized(int runs, double size) { return std::max(1, static_cast<int>(std::lround(runs * size))); }

/// How one ball fared.
struct Fate {
  std::string outcome;
  double duration_s = 0;
  double overlap_m = 0;  ///< deepest into the wall, away from joints
  std::size_t joints_passed = 0;
  std::string end_pipe;
};

const char* Outcome(sim::MotionStatus status) {
  switch (status) {
    case sim::MotionStatus::kRunning:
      return "under way";
    case sim::MotionStatus::kArrived:
      return "arrived";
    case sim::MotionStatus::kBallStuck:
      return "stuck";
    case sim::MotionStatus::kStalledAtTee:
      return "stalled at a tee";
    case sim::MotionStatus::kDeadEnd:
      return "dead end";
    case sim::MotionStatus::kTooLarge:
      return "too large";
    case sim::MotionStatus::kLeftNetwork:
      return "LEFT THE NETWORK";
    case sim::MotionStatus::kNotFinite:
      return "NOT FINITE";
  }
  AbortWith("every status has a name", __FILE__, __LINE__);
}

/// Distance by which the ball stands in the wall of a single pipe; not a statement about joints.
double CalcOverlap_m(const Assembly& assembly, const sim::TruthState& state, double radius_m) {
  if (assembly.bore->FindJoint(state.pipe, state.s_m)) return 0;
  const Pipe& pipe = assembly.network()->pipe(state.pipe);
  const Vector3d p_L = state.X_WB.p - assembly.motion->way()->leg().offset_W;
  return (p_L - pipe.Eval(state.s_m).p_W).norm() + radius_m - pipe.RadiusAt_m(state.s_m);
}

Fate Follow(const Scenario& scenario) {
  Fate fate;
  try {
    const auto assembly = Assemble(scenario);
    sim::Motion& motion = *assembly->motion;
    const TrueTime limit(FromSeconds(scenario.mission.time_limit_s));
    while (motion.status() == sim::MotionStatus::kRunning && motion.state().time < limit) {
      motion.Step();
      fate.overlap_m =
          std::max(fate.overlap_m, CalcOverlap_m(*assembly, motion.state(), scenario.ball.radius_m));
    }
    fate.outcome = Outcome(motion.status());
    fate.duration_s = Seconds(motion.state().time);
    fate.joints_passed = motion.way()->legs().size() - 1;
    fate.end_pipe = assembly->network()->pipe(motion.state().pipe).id;
  } catch (const HydraulicsDiverged&) {
    fate.outcome = "hydraulics diverged";
  }
  return fate;
}

/// A block of runs and how far along the whole study it is.
std::vector<Fate> FollowAll(int count, const ReproduceOptions& options, const std::string& note, double from,
                            double to, const std::function<Scenario(int)>& make) {
  std::vector<Fate> fates(static_cast<std::size_t>(count));
  RunParallel(
      count, options.jobs, options.stop, [&](int i) { fates[static_cast<std::size_t>(i)] = Follow(make(i)); },
      [&](double fraction) {
        if (options.progress) options.progress(from + fraction * (to - from), note);
      });
  return fates;
}

void StudyEscapes(const ReproduceOptions& options, ReproduceReport& report) {
  const int count = Sized(kNetworks, options.size);
  const auto fates = FollowAll(count, options, "random networks", 0, 0.8, [&](int i) {
    return MakeRandomNetwork(options.seed, static_cast<std::uint64_t>(i));
  });
  std::map<std::string, int> outcomes;
  double overlap_m = 0, time_s = 0;
  std::size_t joints = 0;
  for (const Fate& fate : fates) {
    ++outcomes[fate.outcome];
    overlap_m = std::max(overlap_m, fate.overlap_m);
    time_s += fate.duration_s;
    joints += fate.joints_passed;
  }
  ReproducedTable table{"Balls in " + std::to_string(count) + " random networks, up to 60 s each (" +
                            FormatFixed(time_s / 3600, 2) + " h, " + std::to_string(joints) +
                            " joints passed)",
                        {"outcome", "balls"},
                        {}};
  for (const auto& [outcome, balls] : outcomes) table.rows.push_back({outcome, std::to_string(balls)});
  report.tables.push_back(std::move(table));
  const auto none = [&](const char* what, const char* outcome) {
    const auto found = outcomes.find(outcome);
    const int balls = found == outcomes.end() ? 0 : found->second;
    report.figures.push_back({what, std::to_string(balls), "0", balls == 0});
  };
  none("balls outside the bores", "LEFT THE NETWORK");
  none("balls with a state that is not finite", "NOT FINITE");
  none("networks whose hydraulics diverged", "hydraulics diverged");
  report.figures.push_back({"deepest overlap with a pipe's wall [m]", FormatNumber(overlap_m),
                            "<= " + FormatNumber(kOverlap_m), overlap_m <= kOverlap_m});
}

/// Part of the balls that take the second way.
struct Turns {
  int balls = 0;
  int turned = 0;
  double share() const { return static_cast<double>(turned) / std::max(1, balls); }
};

Turns CountTurns(const std::vector<Fate>& fates) {
  Turns turns;
  for (const Fate& fate : fates) {
    if (fate.end_pipe != "P2" && fate.end_pipe != "P3") continue;  // stalled at the joint
    ++turns.balls;
    turns.turned += fate.end_pipe == "P3" ? 1 : 0;
  }
  return turns;
}

Turns StudyTurns(int count, const ReproduceOptions& options, double from, double to,
                 const Scenario& scenario) {
  return CountTurns(FollowAll(count, options, "turns", from, to, [&](int i) {
    Scenario one = scenario;
    one.seed = static_cast<std::int64_t>(options.seed);
    one.run = i;
    return one;
  }));
}

void StudySymmetricY(const ReproduceOptions& options, ReproduceReport& report) {
  const int count = Sized(kTurnsInY, options.size);
  const Turns turns = StudyTurns(count, options, 0.8, 0.9, MakeBranching(-60, 60, 0.5, 0.5));
  // 0.03 for 2,000 balls is 2.7 standard deviations of a fair coin; fewer balls, as much wider
  const double bound = 0.03 * std::sqrt(static_cast<double>(kTurnsInY) / count);
  report.figures.push_back(
      {"symmetric Y, even flow: part of " + std::to_string(turns.balls) + " balls that turn left",
       FormatFixed(turns.share(), 4), "0.5 +- " + FormatFixed(bound, 4),
       turns.balls > 0 && std::abs(turns.share() - 0.5) <= bound});
}

/// Shares against parts that turn; a fall counts when it exceeds three of its standard deviations.
void StudyShares(const char* title, double straight_deg, double branch_deg, double from, double to,
                 const ReproduceOptions& options, ReproduceReport& report) {
  const int count = Sized(kTurnsPerShare, options.size);
  ReproducedTable table{title, {"share of flow", "balls", "part that turns", "+-"}, {}};
  bool rises = true;
  double before = 0, variance_before = 0, last = 0, first = 1;
  for (std::size_t i = 0; i < kShares.size(); ++i) {
    const double step = (to - from) / kShares.size();
    const Turns turns = StudyTurns(count, options, from + step * static_cast<double>(i),
                                   from + step * static_cast<double>(i + 1),
                                   MakeBranching(straight_deg, branch_deg, kShares[i], 0.5));
    const double p = turns.share(), variance = p * (1 - p) / std::max(1, turns.balls);
    table.rows.push_back({FormatFixed(kShares[i], 2), std::to_string(turns.balls), FormatFixed(p, 3),
                          FormatFixed(std::sqrt(variance), 3)});
    if (i > 0 && p < before - 3 * std::sqrt(variance + variance_before)) rises = false;
    if (i == 0) first = p;
    before = last = p;
    variance_before = variance;
  }
  report.tables.push_back(std::move(table));
  report.figures.push_back({std::string(title) + ": rises with the share, from a few to most",
                            FormatFixed(first, 3) + " to " + FormatFixed(last, 3),
                            "monotone, <= 0.2 to >= 0.8", rises && first <= 0.2 && last >= 0.8});
}

ReproduceReport Run(const ReproduceOptions& options) {
  ReproduceReport report;
  StudyEscapes(options, report);
  StudySymmetricY(options, report);
  StudyShares("Y of 2 x 60 degrees", -60, 60, 0.9, 0.95, options, report);
  StudyShares("tee, side branch at 90 degrees", 0, 90, 0.95, 1, options, report);
  return report;
}

}  // namespace

namespace reproductions::networks {
Reproduction Kind() {
  return {"networks", "10,000 balls in random networks: no escape; which way they turn at a Y and at a tee",
          Run};
}
}  // namespace reproductions::networks

}  // namespace piperun::scenarios
