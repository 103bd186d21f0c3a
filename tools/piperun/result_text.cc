#include "tools/piperun/result_text.h"

#include <fmt/core.h>

#include <algorithm>
#include <optional>

#include "tools/piperun/table.h"

namespace piperun::tools {
namespace {

using scenarios::EstimatorResult;
using scenarios::RunResult;
using scenarios::ScoredLeak;
using scenarios::TrackScore;
using scenarios::TrueLeak;

std::string Metres(double value) { return fmt::format("{:.3f}", value); }

std::string Metres(const std::optional<double>& value) { return value ? Metres(*value) : "off the way"; }

/// Ids in order; the middle of a long list is left out.
std::string Chain(const std::vector<std::string>& ids) {
  constexpr std::size_t kShown = 6;
  std::string text;
  for (std::size_t i = 0; i < ids.size(); ++i) {
    if (ids.size() > 2 * kShown && i == kShown) {
      i = ids.size() - kShown;
      text += " > ...";
    }
    text += (text.empty() ? "" : " > ") + ids[i];
  }
  return text;
}

std::string DescribeWay(const RunResult& result) {
  if (result.route_pipes.size() < 2 && result.route_pipes == result.planned_pipes) return "";
  std::string text = "Way: " + Chain(result.route_pipes) + "\n";
  const bool as_planned =
      result.route_pipes.size() <= result.planned_pipes.size() &&
      std::equal(result.route_pipes.begin(), result.route_pipes.end(), result.planned_pipes.begin());
  if (!as_planned) text += "Planned: " + Chain(result.planned_pipes) + "\n";
  return text;
}

std::string LeakRows(const RunResult& result, const EstimatorResult& estimator) {
  Table table({"leak", "true_m", "estimated_m", "error_m", "sigma_m", "confidence"});
  const auto found = [&](const TrueLeak& leak) -> const ScoredLeak* {
    for (const ScoredLeak& scored : estimator.leaks.leaks) {
      if (scored.match == leak.id) return &scored;
    }
    return nullptr;
  };
  for (const TrueLeak& leak : result.leaks) {
    if (const ScoredLeak* scored = found(leak)) {
      table.Add({leak.id, Metres(leak.chainage_m), Metres(scored->estimate.chainage_m),
                 fmt::format("{:+.3f}", *scored->error_m), Metres(scored->estimate.sigma_m),
                 fmt::format("{:.2f}", scored->estimate.confidence)});
    } else {
      table.Add({leak.id, Metres(leak.chainage_m), "-", "-", "-", "-"});
    }
  }
  for (const ScoredLeak& scored : estimator.leaks.leaks) {
    if (scored.match) continue;
    table.Add({"(false alarm)", "-", Metres(scored.estimate.chainage_m), "-", Metres(scored.estimate.sigma_m),
               fmt::format("{:.2f}", scored.estimate.confidence)});
  }
  return table.empty() ? "  no leaks, none reported\n" : table.Text();
}

void AddTrack(Table& table, const std::string& name, const std::string& which,
              const std::optional<TrackScore>& score) {
  if (!score) return;
  table.Add({name, which, fmt::format("{:.3f}", score->attitude_rmse_deg), Metres(score->chainage_rmse_m),
             fmt::format("{:+.3f}", score->chainage_final_error_m), Metres(score->position_rmse_m),
             Metres(score->position_final_error_m), fmt::format("{:.2f}", score->final_error_percent)});
}

}  // namespace

std::string DescribeResult(const RunResult& result) {
  std::string text =
      fmt::format("{}: {}, {:.1f} s simulated in {:.2f} s ({:.0f} x real time)", result.scenario,
                  result.status, result.duration_s, result.wall_s, result.duration_s / result.wall_s);
  if (result.route_length_m > 0) text += fmt::format(", route {:.2f} m", result.route_length_m);
  text += "\n" + DescribeWay(result);
  for (const std::string& note : result.notes) text += "Note: " + note + "\n";
  for (const std::string& warning : result.warnings) text += "Warning: " + warning + "\n";
  for (const EstimatorResult& estimator : result.estimators) {
    text += fmt::format("\nLeaks by '{}': distance along the pipe from the launch\n", estimator.name);
    text += LeakRows(result, estimator);
  }
  Table tracks(
      {"track", "kind", "attitude_deg", "chainage_m", "final_m", "position_m", "final_pos_m", "final_%"});
  for (const EstimatorResult& estimator : result.estimators) {
    AddTrack(tracks, estimator.name, "causal", estimator.causal);
    AddTrack(tracks, estimator.name, "smoothed", estimator.smoothed);
  }
  if (!tracks.empty()) text += "\nTrack errors (root mean square, and at the end)\n" + tracks.Text();
  return text;
}

}  // namespace piperun::tools
