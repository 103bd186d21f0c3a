#include "scenarios/allan_analysis.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "base/number.h"
#include "scenarios/parallel.h"
#include "scenarios/physical_unit.h"
#include "scenarios/run.h"

namespace piperun::scenarios {
namespace {

using estimator::Index;
using estimator::NoiseTerm;

constexpr std::int64_t kFewestSamples = 100;
constexpr double kWorstMisfit = 5;
constexpr double kNoNoise = 20;
constexpr std::int64_t kMostLeftOut = 128;  // samples

/// What is gathered of one channel while the record streams by.
struct Gatherer {
  Gatherer(const estimator::AllanGrid& grid, double period_s) : allan(grid), rest(period_s) {}
  estimator::AllanAccumulator allan;
  RestCheck rest;
};

std::vector<Gatherer> Gather(StaticRecord& record, const AllanOptions& options) {
  std::vector<Gatherer> gatherers;
  RecordBlock block;
  while (record.Next(block)) {
    while (gatherers.size() < block.channels.size())
      gatherers.emplace_back(options.grid, record.timing().period_s);
    for (std::size_t i = 0; i < gatherers.size(); ++i) {
      if (block.starts_segment) gatherers[i].allan.StartSegment(), gatherers[i].rest.StartSegment();
      gatherers[i].allan.Append(block.channels[i]);
      gatherers[i].rest.Append(block.channels[i]);
    }
    if (options.stop && *options.stop) throw Interrupted();
    if (options.progress) options.progress(record.progress());
  }
  return gatherers;
}

std::vector<AllanChannel> MakeChannels(const StaticRecord& record, const std::vector<Gatherer>& gatherers) {
  std::vector<AllanChannel> channels;
  for (const RecordGroup& group : record.groups()) {
    for (const std::string& axis : group.axes) {
      const Gatherer& g = gatherers[channels.size()];
      const RestFindings findings = g.rest.Findings();
      channels.push_back({group.name,
                          axis,
                          group.unit,
                          g.allan.Points(),
                          g.allan.Segments(),
                          {},
                          1,
                          findings.mean,
                          JudgeRest(findings, group.name)});
    }
  }
  return channels;
}

/// A dead axis must not cost the others their analysis; a record of dead axes is refused by the fit.
void LeaveOutStillChannels(std::vector<AllanChannel>& channels, std::vector<std::string>& notes) {
  const auto still = [](const AllanChannel& channel) {
    return std::all_of(channel.points.begin(), channel.points.end(),
                       [](const estimator::AllanPoint& p) { return p.variance == 0; });
  };
  if (std::all_of(channels.begin(), channels.end(), still)) return;
  for (const AllanChannel& channel : channels) {
    if (still(channel))
      notes.push_back(channel.group + " " + channel.axis + " was left out: every sample has the same value");
  }
  std::erase_if(channels, still);
}

void AddTrouble(const RecordTrouble& trouble, const std::string& what, std::vector<std::string>& notes) {
  if (trouble.count == 0) return;
  notes.push_back(std::to_string(trouble.count) + " " + what + " (first: " + trouble.first + ")");
}

void AddTimingNotes(const RecordTiming& timing, std::vector<std::string>& notes) {
  AddTrouble(timing.gaps,
             "gaps in the time stamps, " + FormatDigits(timing.missing_s, 4) +
                 " s missing: nothing was filled in, no difference reaches over a gap",
             notes);
  AddTrouble(timing.duplicated, "rows that repeat a time stamp were left out", notes);
  AddTrouble(timing.not_finite,
             "rows with an empty, nan or infinite value were left out; each ends a segment", notes);
  AddTrouble(timing.corrupt, "corrupt rows were left out; each ends a segment", notes);
  if (timing.jitter_max_s > 0.05 * timing.period_s) {
    notes.push_back("time stamps jitter by " + FormatDigits(1e3 * timing.jitter_sd_s, 3) + " ms (at most " +
                    FormatDigits(1e3 * timing.jitter_max_s, 3) +
                    " ms): samples are taken as evenly spaced at " + FormatDigits(1 / timing.period_s, 7) +
                    " Hz");
  }
}

void AddChannelNotes(const AllanChannel& channel, double period_s, std::vector<std::string>& notes) {
  for (const std::string& unrest : channel.unrest) {
    notes.push_back(channel.group + " " + channel.axis + " was not at rest: " + unrest);
  }
  if (channel.shortest_cluster > 1) {
    notes.push_back(channel.group + " " + channel.axis + ": the fit leaves out clusters below " +
                    std::to_string(channel.shortest_cluster) + " samples (" +
                    FormatDigits(static_cast<double>(channel.shortest_cluster) * period_s, 3) + " s)");
  }
  if (channel.fit.worst_misfit > kWorstMisfit) {
    notes.push_back(channel.group + " " + channel.axis +
                    ": the terms do not describe this record; at tau = " +
                    FormatDigits(channel.fit.worst_misfit_tau_s, 3) + " s it lies " +
                    FormatDigits(channel.fit.worst_misfit, 3) + " standard deviations off the fit");
  }
}

/// Motion that lasts all the time is as rough as its own median; but no noise of IEEE Std 952 looks like it.
void JudgeMisfit(AllanChannel& channel) {
  if (channel.fit.worst_misfit < kNoNoise || !channel.unrest.empty()) return;
  channel.unrest.push_back(
      "its deviation is that of no noise: at tau = " + FormatDigits(channel.fit.worst_misfit_tau_s, 3) +
      " s it lies " + FormatDigits(channel.fit.worst_misfit, 3) +
      " standard deviations off the best sum of terms");
}

/// The accelerations of three axes at rest make up gravity, whatever the attitude.
void AddGravityNote(const std::vector<AllanChannel>& channels, std::vector<std::string>& notes) {
  double squares = 0;
  int axes = 0;
  for (const AllanChannel& channel : channels) {
    if (channel.group == "accel") squares += channel.mean * channel.mean, ++axes;
  }
  if (axes == 3 && std::abs(std::sqrt(squares) / 9.80665 - 1) > 0.1) {
    notes.push_back("the mean specific force is " + FormatDigits(std::sqrt(squares), 4) +
                    " m/s^2, not gravity's 9.8: a wrong unit, or a sensor that moved");
  }
}

bool Describes(const estimator::AllanFit& fit) { return fit.worst_misfit <= kWorstMisfit; }

/// True when a record is smoother than its fit at the clusters that the next try leaves out.
bool IsSmoothAt(const AllanChannel& channel, std::int64_t next_shortest) {
  const double below_s = channel.fit.model.shape.period_s * static_cast<double>(next_shortest);
  const auto point = std::find_if(channel.points.begin(), channel.points.end(), [&](const auto& p) {
    return p.cluster.samples >= channel.shortest_cluster;
  });
  return point != channel.points.end() && channel.fit.worst_misfit_tau_s < below_s &&
         point->variance < CalcAllanVariance(channel.fit.model, point->cluster.samples);
}

void FitChannel(double period_s, const AllanOptions& options, AllanChannel& channel) {
  estimator::AllanFitOptions fit = options.fit;
  const auto refit = [&](std::int64_t shortest_cluster) {
    fit.shortest_cluster = shortest_cluster;
    channel.shortest_cluster = shortest_cluster;
    channel.fit = FitAllan(channel.points, channel.segments, period_s, fit);
  };
  refit(options.fit.shortest_cluster);
  if (!options.leave_out_smooth || channel.points.back().cluster.samples <= kMostLeftOut) return;
  const AllanChannel whole = channel;
  while (!Describes(channel.fit) && 2 * channel.shortest_cluster <= kMostLeftOut &&
         IsSmoothAt(channel, 2 * channel.shortest_cluster)) {
    refit(2 * channel.shortest_cluster);
  }
  if (!Describes(channel.fit)) channel = whole;  // something else is wrong: say so of the whole record
}

}  // namespace

bool AllanAnalysis::at_rest() const {
  return std::all_of(channels.begin(), channels.end(),
                     [](const AllanChannel& c) { return c.unrest.empty(); });
}

AllanAnalysis AnalyseStaticRecord(StaticRecord& record, const std::string& file,
                                  const AllanOptions& options) {
  const std::vector<Gatherer> gatherers = Gather(record, options);
  AllanAnalysis analysis{file, record.timing(), {}, options.fit.confidence, {}};
  if (analysis.timing.rows < kFewestSamples) {
    throw InputError("the record has " + std::to_string(analysis.timing.rows) +
                         " samples; an Allan deviation needs " + std::to_string(kFewestSamples) +
                         " or more, a fit hours",
                     "", file);
  }
  analysis.channels = MakeChannels(record, gatherers);
  auto& channels = analysis.channels;
  LeaveOutStillChannels(channels, analysis.notes);
  RunParallel(
      static_cast<int>(channels.size()), options.jobs, options.stop,
      [&](int i) {
        AllanChannel& channel = channels[static_cast<std::size_t>(i)];
        try {
          FitChannel(analysis.timing.period_s, options, channel);
        } catch (const InputError& e) {
          throw InputError(e.problem(), channel.group + " " + channel.axis, file);
        }
      },
      [](double) {});
  for (const std::string& note : record.notes()) analysis.notes.push_back(note);
  AddTimingNotes(analysis.timing, analysis.notes);
  for (AllanChannel& channel : channels) JudgeMisfit(channel);
  for (const AllanChannel& channel : channels)
    AddChannelNotes(channel, analysis.timing.period_s, analysis.notes);
  AddGravityNote(channels, analysis.notes);
  return analysis;
}

std::string NoiseTermUnit(NoiseTerm term, const std::string& unit) {
  PhysicalUnit base = ParseUnit(unit, "");
  constexpr double kSeconds[] = {1, 0.5, 0, -0.5, -1, 0};
  base.exponents[2] += kSeconds[Index(term)];
  return SiUnitText(base);
}

std::string NoiseTermName(NoiseTerm term, const std::string& group) {
  const char* walk = group == "gyro"    ? "N angle random walk"
                     : group == "accel" ? "N velocity random walk"
                                        : "N white noise";
  const std::array<const char*, estimator::kNoiseTerms> names{"Q quantisation",     walk,
                                                              "B bias instability", "K rate random walk",
                                                              "R rate ramp",        "Gauss-Markov sigma"};
  return names[Index(term)];
}

std::optional<double> CombineAxes(const AllanAnalysis& analysis, const std::string& group, NoiseTerm term) {
  double squares = 0;
  int axes = 0;
  for (const AllanChannel& channel : analysis.channels) {
    const estimator::FittedTerm& fitted = channel.fit.terms[Index(term)];
    if (channel.group != group || !fitted.identifiable) continue;
    squares += fitted.value * fitted.value;
    ++axes;
  }
  if (axes == 0) return std::nullopt;
  return std::sqrt(squares / axes);
}

double BoundAxes(const AllanAnalysis& analysis, const std::string& group, NoiseTerm term) {
  double bound = 0;
  for (const AllanChannel& channel : analysis.channels) {
    if (channel.group == group) bound = std::max(bound, channel.fit.terms[Index(term)].interval.high);
  }
  return bound;
}

}  // namespace piperun::scenarios
