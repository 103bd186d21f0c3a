// Every preset of sensors: hours at rest, their Allan deviation and its fit next to what the data sheet says.

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>

#include "base/check.h"
#include "base/number.h"
#include "scenarios/allan_report.h"
#include "scenarios/output_file.h"
#include "scenarios/parallel.h"
#include "scenarios/physical_unit.h"
#include "scenarios/reproduction.h"
#include "scenarios/rest_record.h"
#include "scenarios/rest_recording.h"
#include "scenarios/sensor_presets.h"
#include "sim/imu_params.h"

namespace piperun::scenarios {
namespace {

using estimator::Index;
using estimator::NoiseTerm;

constexpr double kDuration_s = 9000;
constexpr double kShortest_s = 300;
constexpr double kTogether = 0.95;  // confidence that the intervals hold, all at once
constexpr char kChannel[] = "imu0";
constexpr NoiseTerm kTerms[] = {NoiseTerm::kWhite, NoiseTerm::kFlicker, NoiseTerm::kRateRandomWalk};
constexpr char kLetters[] = {'N', 'B', 'K'};

struct Board {
  std::string name;
  Scenario scenario;
  sim::ImuParams params;
};

/// One term of one triad, in the triad's unit: what the preset says and what its record shows.
struct Comparison {
  const char* group;
  const char* unit;
  std::size_t term;     // of kTerms
  double sheet = 0;     // what the preset says
  double expected = 0;  // N with the white noise of the output register on top
  estimator::FittedTerm fitted{};
  bool identifiable = false;  // by the tool's usual 95 %

  bool Agrees() const {
    return expected <= fitted.interval.high && (!identifiable || expected >= fitted.interval.low);
  }
};

double Duration_s(const ReproduceOptions& options) {
  return std::max(kShortest_s, kDuration_s * std::min(options.size, 1.0));
}

std::vector<Board> LoadBoards(const ReproduceOptions& options) {
  std::vector<Board> boards;
  for (const SensorPreset& preset : SensorPresets()) {
    if (!preset.Find("imu")) continue;
    const RestOptions rest{Duration_s(options), {}, {"seed=" + std::to_string(options.seed)}};
    boards.push_back({preset.name, LoadRestScenario(preset.name, rest), {}});
    for (const SensorEntry& entry : boards.back().scenario.sensors) {
      if (entry.name == kChannel)
        boards.back().params = dynamic_cast<const sim::ImuParams&>(entry.kind.params());
    }
  }
  return boards;
}

std::vector<Comparison> MakeComparisons(const sim::ImuParams& params) {
  std::vector<Comparison> all;
  const auto add = [&](const char* group, const char* unit, const sim::TriadErrorParams& triad) {
    const double sheet[] = {triad.noise, triad.bias_instability, triad.rate_random_walk};
    const double rounding = triad.resolution / std::sqrt(12 * params.rate_Hz);
    for (std::size_t i = 0; i < std::size(kTerms); ++i) {
      if (sheet[i] == 0) continue;
      const double expected = kTerms[i] == NoiseTerm::kWhite ? std::hypot(sheet[i], rounding) : sheet[i];
      all.push_back({group, unit, i, sheet[i], expected});
    }
  };
  add("gyro", "rad/s", params.gyro);
  add("accel", "m/s^2", params.accel);
  return all;
}

/// How much later a low-pass lets white noise add up: once it has settled, the integral of filtered noise of
/// density N has the variance N^2 (t - a), a = twice the first moment of its covariance over N^2: 1 / w_c for
/// the first order, 1 / (sqrt(2) w_c) for the Butterworth pair; of a cascade at most the sum.
double CalcFilterLag_s(const sim::ImuFilterParams& filter) {
  const auto lag_s = [](std::int64_t order, double bandwidth_Hz) {
    return 1 / (2 * std::numbers::pi * bandwidth_Hz * (order == 2 ? std::numbers::sqrt2 : 1));
  };
  Demand(filter.digital != "boxcar", "no preset has a boxcar, whose length hangs on the physics rate");
  double sum_s = 0;
  if (filter.analogue_bandwidth_Hz) sum_s += lag_s(filter.analogue_order, *filter.analogue_bandwidth_Hz);
  if (filter.digital != "none")
    sum_s += lag_s(filter.digital == "low_pass_2" ? 2 : 1, filter.digital_bandwidth_Hz);
  return sum_s;
}

/// White noise behind a lag a has the Allan variance N^2 / tau (1 - 1.5 a / tau): clusters below 750 a would
/// tell N more than 0.1 % too low.
std::int64_t FindShortestCluster(const sim::ImuParams& params) {
  constexpr double kLags = 750;
  const double lag_s = std::max(CalcFilterLag_s(params.gyro.filter), CalcFilterLag_s(params.accel.filter));
  return std::max<std::int64_t>(1, std::llround(std::ceil(kLags * lag_s * params.rate_Hz)));
}

/// Axes of one law are segments of one longer record.
AllanChannel PoolAxes(const AllanAnalysis& analysis, const std::string& group) {
  std::vector<const AllanChannel*> axes;
  for (const AllanChannel& channel : analysis.channels) {
    if (channel.group == group) axes.push_back(&channel);
  }
  AllanChannel pooled = *axes.front();
  const auto n = static_cast<std::int64_t>(axes.size());
  for (std::size_t i = 0; i < pooled.points.size(); ++i) {
    pooled.points[i].variance = 0;
    for (const AllanChannel* axis : axes)
      pooled.points[i].variance += axis->points[i].variance / static_cast<double>(n);
    pooled.points[i].count *= n;
  }
  for (estimator::SegmentGroup& segments : pooled.segments) segments.segments *= n, segments.samples *= n;
  return pooled;
}

/// Fits every triad's axes together, once with the usual confidence and once with the one asked for.
void FitTriads(const AllanAnalysis& analysis, std::int64_t shortest_cluster, double confidence,
               std::vector<Comparison>& terms) {
  for (Comparison& c : terms) {
    const AllanChannel pooled = PoolAxes(analysis, c.group);
    estimator::AllanFitOptions options;
    options.shortest_cluster = shortest_cluster;
    const auto fit = [&] {
      return FitAllan(pooled.points, pooled.segments, analysis.timing.period_s, options)
          .terms[Index(kTerms[c.term])];
    };
    c.identifiable = fit().identifiable;
    options.confidence = confidence;
    c.fitted = fit();
  }
}

struct Study {
  const ReproduceOptions& options;
  double confidence;  // of one interval
};

void CompareBoard(const Board& board, const Study& study, std::vector<Comparison>& terms) {
  const auto record = SimulateStaticRecord(board.scenario, kChannel, Duration_s(study.options));
  AllanOptions allan;
  allan.fit.shortest_cluster = FindShortestCluster(board.params);
  allan.jobs = 1;
  allan.stop = study.options.stop;
  const AllanAnalysis analysis = AnalyseStaticRecord(*record, board.name, allan);
  FitTriads(analysis, allan.fit.shortest_cluster, study.confidence, terms);
  if (!study.options.out.empty())
    WriteTextFile(study.options.out / (board.name + ".svg"), DrawAllanSvg(analysis));
}

/// Samples that are not like the first one.
std::int64_t CountChanges(const Board& board, const ReproduceOptions& options) {
  const auto record = SimulateStaticRecord(board.scenario, kChannel, Duration_s(options));
  std::int64_t changes = 0;
  std::vector<double> first;
  for (RecordBlock block; record->Next(block);) {
    for (std::size_t i = 0; i < block.channels.size(); ++i) {
      if (first.size() <= i) first.push_back(block.channels[i].front());
      for (const double value : block.channels[i]) changes += value != first[i];
    }
  }
  return changes;
}

/// In the unit that data sheets give the term in.
class SheetUnit {
 public:
  explicit SheetUnit(const Comparison& c) {
    const PhysicalUnit si = ParseUnit(NoiseTermUnit(kTerms[c.term], c.unit), "");
    name_ = DataSheetUnits(si).front();
    factor_ = ParseUnit(name_, "").factor;
  }
  const std::string& name() const { return name_; }
  std::string Text(double value_si) const { return FormatDigits(value_si / factor_, 4); }

 private:
  std::string name_;
  double factor_;
};

std::string ResultText(const Comparison& c) {
  if (!c.Agrees()) return "differs";
  return c.identifiable ? "ok" : "not identifiable";
}

std::vector<std::string> MakeRow(const std::string& board, const Comparison& c) {
  const SheetUnit unit(c);
  const std::string interval =
      c.identifiable ? unit.Text(c.fitted.interval.low) + " to " + unit.Text(c.fitted.interval.high)
                     : "below " + unit.Text(c.fitted.interval.high);
  return {board,
          c.group,
          std::string(1, kLetters[c.term]),
          unit.name(),
          unit.Text(c.sheet),
          unit.Text(c.expected),
          c.identifiable ? unit.Text(c.fitted.value) : "-",
          interval,
          ResultText(c)};
}

void ReportBoard(const Board& board, const std::vector<Comparison>& terms, std::int64_t changes,
                 ReproduceReport& report) {
  for (const Comparison& c : terms) report.tables.back().rows.push_back(MakeRow(board.name, c));
  if (terms.empty()) {
    report.figures.push_back({board.name + ": samples unlike the first one", std::to_string(changes), "0",
                              changes == 0, "a sensor without noise"});
    return;
  }
  const auto agreeing =
      std::count_if(terms.begin(), terms.end(), [](const Comparison& c) { return c.Agrees(); });
  report.figures.push_back({board.name + ": terms whose interval holds the preset's value",
                            std::to_string(agreeing), std::to_string(terms.size()),
                            agreeing == std::ssize(terms), "assets/sensors"});
}

ReproduceReport CompareBoards(const ReproduceOptions& options) {
  const std::vector<Board> boards = LoadBoards(options);
  std::vector<std::vector<Comparison>> terms;
  std::size_t comparisons = 0;
  for (const Board& board : boards) comparisons += terms.emplace_back(MakeComparisons(board.params)).size();
  const Study study{options, 1 - (1 - kTogether) / static_cast<double>(comparisons)};
  if (!options.out.empty()) std::filesystem::create_directories(options.out);
  std::vector<std::int64_t> changes(boards.size());
  const auto work = [&](int index) {
    const auto i = static_cast<std::size_t>(index);
    if (terms[i].empty()) {
      changes[i] = CountChanges(boards[i], options);
    } else {
      CompareBoard(boards[i], study, terms[i]);
    }
  };
  RunParallel(static_cast<int>(boards.size()), options.jobs, options.stop, work, [&](double fraction) {
    if (options.progress) options.progress(fraction, "boards");
  });
  ReproduceReport report;
  report.tables.push_back(
      {FormatNumber(Duration_s(options)) + " s at rest, three axes fitted together; intervals of " +
           FormatDigits(100 * study.confidence, 5) +
           " %, so that all hold at once with 95 %; 0.664 B is the floor",
       {"sensor", "triad", "term", "unit", "preset", "with register", "fitted", "interval", "result"},
       {}});
  for (std::size_t i = 0; i < boards.size(); ++i) ReportBoard(boards[i], terms[i], changes[i], report);
  return report;
}

}  // namespace

namespace reproductions::sensors {
Reproduction Kind() {
  return {"sensors", "Every preset of sensors at rest for 2.5 h: fitted N, B and K next to the data sheet's",
          CompareBoards, true};
}
}  // namespace reproductions::sensors

}  // namespace piperun::scenarios
