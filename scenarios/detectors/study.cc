#include "scenarios/detectors/study.h"

#include <algorithm>
#include <cmath>

#include "acoustics/pipe_wave.h"
#include "base/random.h"
#include "estimator/chi_square.h"
#include "scenarios/materials.h"
#include "scenarios/parallel.h"
#include "scenarios/score.h"
#include "scenarios/yaml_document.h"

namespace piperun::scenarios::detectors {
namespace {

constexpr double kRun_m = 1200;
constexpr double kNormal95 = 1.959963984540054;

/// A material of the library, its loss factor (uncertain by a factor of two) as the studied slope needs it.
StudiedPipe MakePipe(const std::string& material, double loss_factor, double bore_m,
                     double wall_thickness_m) {
  const WallParams wall = FindWall(material, {});
  StudiedPipe pipe;
  pipe.survey.pipe = material;
  pipe.survey.wall = {material,           wall.young_modulus_Pa, loss_factor,
                      wall.poisson_ratio, wall.density_kg_m3,    wall.roughness_m};
  pipe.survey.bore_m = bore_m;
  pipe.survey.wall_thickness_m = wall_thickness_m;
  const auto wave = acoustics::CalcPipeWave(bore_m, wall_thickness_m, pipe.survey.wall, CalcWater(10));
  pipe.slope_dB_m = 20 / std::log(10.0) * wave.Attenuation_Np_m(2000);
  return pipe;
}

/// One run: a survey and what is to be found.
struct Job {
  const StudiedPipe* pipe = nullptr;
  std::optional<double> snr_dB;
  std::uint64_t run = 0;
  int leaks = 0;
  double length_m = 0;
};

struct Outcome {
  std::vector<TrueLeak> leaks;
  std::vector<std::vector<estimator::LeakEstimate>> found;  // per locator
};

std::vector<Job> PlanPipe(const StudiedPipe& pipe, const StudySize& size, std::uint64_t& run) {
  std::vector<Job> jobs;
  const int per_run = std::max(1, static_cast<int>(kRun_m / pipe.spacing_m));
  for (const Cell& cell : pipe.cells) {
    for (int left = std::max(1, static_cast<int>(std::lround(cell.share * size.leaks_per_cell))); left > 0;
         left -= per_run) {
      const int leaks = std::min(left, per_run);
      jobs.push_back({&pipe, cell.snr_dB, run++, leaks, leaks * pipe.spacing_m});
    }
  }
  for (double left_m = 1000 * size.quiet_km; left_m > 0; left_m -= kRun_m)
    jobs.push_back({&pipe, std::nullopt, run++, 0, std::min(left_m, kRun_m)});
  return jobs;
}

Survey MakeJobSurvey(const Job& job, std::uint64_t seed) {
  Survey survey = job.pipe->survey;
  survey.length_m = job.length_m;
  const RandomStream random(seed, "survey_leaks", job.run);
  for (int i = 0; i < job.leaks; ++i) {
    const double u = random.Uniforms(static_cast<std::uint64_t>(i), 0)[0];
    const double s_m = (i + 0.3 + 0.4 * u) * job.pipe->spacing_m;
    const double loudness_dB = kLoudness_dB * random.Normals(static_cast<std::uint64_t>(i), 1)[0];
    survey.leaks.push_back({s_m, *job.snr_dB, loudness_dB});
  }
  return survey;
}

std::vector<TrueLeak> ToTruth(const Survey& survey) {
  std::vector<TrueLeak> truth;
  for (const SurveyLeak& leak : survey.leaks) {
    TrueLeak known;
    known.id = std::to_string(truth.size());
    known.chainage_m = leak.chainage_m;
    known.flow_m3_s = MakeJetOfSnr(survey, leak.snr_dB, leak.loudness_dB).flow_m3_s;
    truth.push_back(known);
  }
  return truth;
}

Outcome Listen(const Job& job, std::uint64_t seed) {
  const Survey survey = MakeJobSurvey(job, seed);
  const auto start = MakeSurveyStart(survey);
  std::vector<std::unique_ptr<estimator::LeakLocator>> locators;
  std::vector<estimator::LeakLocator*> listening;
  for (const estimator::LocatorKind& kind : estimator::LocatorKinds()) {
    locators.push_back(MakeStudiedLocator(kind, start));
    listening.push_back(locators.back().get());
  }
  RunSurvey(survey, seed, job.run, listening);
  Outcome outcome{ToTruth(survey), {}};
  for (const auto& locator : locators) outcome.found.push_back(locator->leaks());
  return outcome;
}

void AddFound(const ScoredLeak& scored, Tally& tally) {
  ++tally.found;
  tally.errors_m.push_back(*scored.error_m);
  tally.covered += *scored.covered ? 1 : 0;
  if (!scored.flow_error_dB) return;
  const double error_dB = *scored.flow_error_dB;
  tally.flow_errors_dB.push_back(error_dB);
  tally.flow_covered += std::abs(error_dB) <= kNormal95 * scored.estimate.flow_sigma_dB ? 1 : 0;
}

void AddRun(const Job& job, const Outcome& outcome, std::size_t locator, Tally& tally) {
  const LeakScore score = ScoreLeaks(outcome.found[locator], outcome.leaks, job.pipe->match_radius_m);
  tally.km += job.length_m / 1000;
  tally.leaks += static_cast<int>(outcome.leaks.size());
  tally.false_alarms += score.false_alarms;
  for (const ScoredLeak& scored : score.leaks)
    if (scored.match) AddFound(scored, tally);
}

/// Of one pipe and loudness: the tallies of all locators.
std::vector<Tally*> FindTallies(const Job& job, std::vector<Tally>& tallies) {
  std::vector<Tally*> found;
  for (Tally& tally : tallies)
    if (tally.pipe == job.pipe->survey.pipe && tally.snr_dB == job.snr_dB) found.push_back(&tally);
  return found;
}

std::vector<Tally> MakeTallies(const std::vector<StudiedPipe>& pipes) {
  std::vector<Tally> tallies;
  for (const StudiedPipe& pipe : pipes) {
    std::vector<std::optional<double>> loudness;
    for (const Cell& cell : pipe.cells) loudness.emplace_back(cell.snr_dB);
    loudness.emplace_back();
    for (const auto& snr_dB : loudness) {
      for (const estimator::LocatorKind& kind : estimator::LocatorKinds()) {
        Tally& tally = tallies.emplace_back();
        tally.pipe = pipe.survey.pipe;
        tally.locator = kind.name;
        tally.snr_dB = snr_dB;
        tally.slope_dB_m = pipe.slope_dB_m;
      }
    }
  }
  return tallies;
}

}  // namespace

std::vector<StudiedPipe> StudiedPipes() {
  StudiedPipe plastic = MakePipe("pvc_u", 0.0312, 0.1475, 0.0075);
  plastic.spacing_m = 40;
  plastic.match_radius_m = 2;
  plastic.cells = {{-6, 0.25}, {-3, 0.25}, {0, 1}, {3, 1}, {6, 1}, {10, 0.25}};
  StudiedPipe cement = MakePipe("asbestos_cement", 0.037, 0.15, 0.013);
  cement.spacing_m = 100;
  cement.match_radius_m = 2;
  cement.cells = {{-3, 0.25}, {0, 0.25}, {3, 1}, {6, 1}, {10, 0.25}};
  StudiedPipe iron = MakePipe("ductile_iron", 0.02, 0.158, 0.006);
  iron.spacing_m = 600;
  iron.match_radius_m = 5;
  iron.cells = {{3, 0.125}, {6, 0.125}, {10, 1}};
  return {plastic, cement, iron};
}

std::unique_ptr<estimator::LeakLocator> MakeStudiedLocator(const estimator::LocatorKind& kind,
                                                           const estimator::EstimatorStart& start) {
  const auto params = kind.make_params();
  if (kind.name == "envelope_peak") {
    const YamlDocument many("max_leaks: 1000", "the detector study");
    many.ReadSome([&](ParamVisitor& v) { params->Visit(v); });
  }
  return kind.make(*params, start);
}

std::vector<Tally> StudyDetectors(const StudySize& size) {
  const auto pipes = StudiedPipes();
  std::vector<Job> jobs;
  std::uint64_t run = 0;
  for (const StudiedPipe& pipe : pipes) {
    const auto planned = PlanPipe(pipe, size, run);
    jobs.insert(jobs.end(), planned.begin(), planned.end());
  }
  std::vector<Outcome> outcomes(jobs.size());
  RunParallel(
      static_cast<int>(jobs.size()), size.jobs, size.stop,
      [&](int i) {
        const auto at = static_cast<std::size_t>(i);
        outcomes[at] = Listen(jobs[at], size.seed);
      },
      [&](double fraction) {
        if (size.progress) size.progress(fraction);
      });
  std::vector<Tally> tallies = MakeTallies(pipes);
  for (std::size_t i = 0; i < jobs.size(); ++i) {
    const auto rows = FindTallies(jobs[i], tallies);
    for (std::size_t locator = 0; locator < rows.size(); ++locator)
      AddRun(jobs[i], outcomes[i], locator, *rows[locator]);
  }
  return tallies;
}

std::optional<double> InterpolateFound(const std::vector<Tally>& tallies, const std::string& pipe,
                                       const std::string& locator, double snr_dB) {
  const Tally *below = nullptr, *above = nullptr;
  for (const Tally& t : tallies) {
    if (t.pipe != pipe || t.locator != locator || !t.snr_dB || t.leaks == 0) continue;
    if (*t.snr_dB <= snr_dB && (!below || *t.snr_dB > *below->snr_dB)) below = &t;
    if (*t.snr_dB >= snr_dB && (!above || *t.snr_dB < *above->snr_dB)) above = &t;
  }
  if (!below || !above) return std::nullopt;
  const auto share = [](const Tally* t) { return static_cast<double>(t->found) / t->leaks; };
  const double step_dB = *above->snr_dB - *below->snr_dB;
  return step_dB > 0 ? share(below) + (snr_dB - *below->snr_dB) / step_dB * (share(above) - share(below))
                     : share(below);
}

ShareInterval CalcWilsonInterval(int k, int n) {
  if (n == 0) return {};
  const double p = static_cast<double>(k) / n, z2 = kNormal95 * kNormal95;
  const double centre = (p + z2 / (2 * n)) / (1 + z2 / n);
  const double half = kNormal95 / (1 + z2 / n) * std::sqrt(p * (1 - p) / n + z2 / (4.0 * n * n));
  return {std::max(0.0, centre - half), std::min(1.0, centre + half)};
}

CountInterval CalcPoissonInterval(int k) {
  return {k > 0 ? 0.5 * estimator::CalcChiSquareQuantile(0.025, 2.0 * k) : 0,
          0.5 * estimator::CalcChiSquareQuantile(0.975, 2.0 * k + 2)};
}

std::optional<double> CalcAbsoluteQuantile(std::vector<double> values, double p) {
  if (values.empty()) return std::nullopt;
  for (double& value : values) value = std::abs(value);
  std::sort(values.begin(), values.end());
  const double at = p * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::size_t>(at);
  const auto above = std::min(below + 1, values.size() - 1);
  return values[below] + (at - static_cast<double>(below)) * (values[above] - values[below]);
}

}  // namespace piperun::scenarios::detectors
