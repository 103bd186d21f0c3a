// Replay(): recorded measurements through estimators, scored with the run folder's own truth.

#include <algorithm>

#include "base/check.h"
#include "base/nearest_name.h"
#include "estimator/filter_kind.h"
#include "scenarios/estimator_bank.h"
#include "scenarios/load.h"
#include "scenarios/output_file.h"
#include "scenarios/replay.h"
#include "scenarios/run.h"
#include "scenarios/run_folder.h"
#include "scenarios/run_json.h"
#include "scenarios/seal.h"
#include "scenarios/truth_log.h"

namespace piperun::scenarios {
namespace {

namespace fs = std::filesystem;

/// A recorded estimator by name, or any filter by its kind with default parameters and the first one's start.
ToldEstimator ChooseEstimator(const std::vector<ToldEstimator>& recorded, const std::string& wanted) {
  std::vector<std::string> known;
  for (const ToldEstimator& told : recorded) {
    if (told.name == wanted) return told;
    known.push_back(told.name);
  }
  for (const KindOption& option : FilterOptions()) {
    if (option.name == wanted && !recorded.empty()) {
      return {wanted, KindEntry(FilterOptions, wanted), recorded.front().start};
    }
    known.emplace_back(option.name);
  }
  std::string problem = "'" + wanted + "' is neither an estimator of this run nor a kind of filter";
  if (const auto near = FindNearestName(wanted, known)) problem += "; did you mean '" + *near + "'?";
  throw InputError(problem, "--estimators");
}

std::vector<ToldEstimator> ChooseEstimators(const std::vector<ToldEstimator>& recorded,
                                            const std::vector<std::string>& wanted) {
  if (wanted.empty()) return recorded;
  std::vector<ToldEstimator> chosen;
  for (const std::string& name : wanted) chosen.push_back(ChooseEstimator(recorded, name));
  return chosen;
}

/// The folder written must not be, hold, or lie in the folder read.
void RequireApart(const fs::path& from, const fs::path& out) {
  const std::string a = (fs::weakly_canonical(from) / "").string(),
                    b = (fs::weakly_canonical(out) / "").string();
  if (a.starts_with(b) || b.starts_with(a)) {
    throw InputError("this would write over the record it reads; choose another folder", "--out",
                     out.string());
  }
}

}  // namespace

RunResult Replay(const ReplayOptions& options) {
  const auto begin = StartWatch();
  const fs::path& from = options.run_folder;
  if (!fs::is_directory(from)) throw InputError("there is no such run folder", "", from.string());
  RequireApart(from, options.out);
  EstimatorInput input = LoadEstimatorInput((from / "estimator_input.yaml").string());
  input.estimators = ChooseEstimators(input.estimators, options.estimators);
  const Scenario scenario = LoadScenario((from / "scenario.yaml").string());
  const ClockModel clock{FromSeconds(scenario.ball.clock_offset_s), scenario.ball.clock_drift_ppm};

  MeasurementLog log(from, input);
  const auto open_truth = [&] { return OpenTruth(from / "truth" / "ball.csv", clock); };
  RunFolder folder(options.out, options.force);
  WriteTextFile(folder.staging() / "estimator_input.yaml",
                WriteYaml([&](ParamVisitor& v) { input.Visit(v); }));
  EstimatorBank bank(input, folder.staging() / "estimates", open_truth());
  RunResult result = LoadRunSummary(ReadTextFile(from / "run.json"));
  while (const Measurement* measurement = log.Next()) {
    if (options.stop && *options.stop) throw Interrupted();
    bank.Ingest(*measurement);
  }
  result.leaks = LoadTrueLeaks(from / "truth" / "leaks.csv");
  result.estimators = bank.Finish(result.leaks, scenario.score.match_radius_m, open_truth);
  Seal(folder, begin, result);
  return result;
}

}  // namespace piperun::scenarios
