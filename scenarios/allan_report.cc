#include "scenarios/allan_report.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/check.h"
#include "base/number.h"

namespace piperun::scenarios {
namespace {

using estimator::Index;
using estimator::NoiseTerm;
using Json = nlohmann::ordered_json;

constexpr const char* kTermKeys[] = {"Q", "N", "B", "K", "R", "gauss_markov_sigma"};

Json FiniteOrNull(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json TermJson(const estimator::FittedTerm& term, const std::string& unit) {
  return {{"value", term.identifiable ? Json(term.value) : Json(nullptr)},
          {"unit", unit},
          {"interval", {term.interval.low, FiniteOrNull(term.interval.high)}},
          {"identifiable", term.identifiable}};
}

Json TermsJson(const AllanChannel& channel) {
  Json terms = Json::object();
  for (std::size_t i = 0; i < estimator::kNoiseTerms; ++i) {
    const auto term = static_cast<NoiseTerm>(i);
    if (term == NoiseTerm::kGaussMarkov && channel.fit.terms[i].interval.high == 0) continue;
    terms[kTermKeys[i]] = TermJson(channel.fit.terms[i], NoiseTermUnit(term, channel.unit));
    if (term == NoiseTerm::kGaussMarkov)
      terms["gauss_markov_time"] = TermJson(channel.fit.gauss_markov_time_s, "s");
  }
  return terms;
}

Json PointsJson(const AllanChannel& channel, double period_s, double confidence) {
  Json points = Json::array();
  for (std::size_t i = 0; i < channel.points.size(); ++i) {
    const estimator::AllanPoint& p = channel.points[i];
    const double dof = channel.fit.degrees_of_freedom[i];
    const auto interval = estimator::CalcVarianceInterval(p.variance, dof, confidence);
    points.push_back({{"tau_s", period_s * static_cast<double>(p.cluster.samples)},
                      {"deviation", std::sqrt(p.variance)},
                      {"low", std::sqrt(interval.low)},
                      {"high", FiniteOrNull(std::sqrt(interval.high))},
                      {"fit", std::sqrt(CalcAllanVariance(channel.fit.model, p.cluster.samples))},
                      {"degrees_of_freedom", FiniteOrNull(dof)},
                      {"stride", p.cluster.stride}});
  }
  return points;
}

Json TimingJson(const RecordTiming& t) {
  return {{"samples", t.rows},
          {"rate_Hz", 1 / t.period_s},
          {"jitter_sd_s", t.jitter_sd_s},
          {"jitter_max_s", t.jitter_max_s},
          {"gaps", t.gaps.count},
          {"missing_s", t.missing_s},
          {"duplicated_rows", t.duplicated.count},
          {"not_finite_rows", t.not_finite.count},
          {"corrupt_rows", t.corrupt.count}};
}

/// "key: value", or the bound with a comment where there is no value.
std::string KalibrLine(const AllanAnalysis& analysis, const std::string& key, const std::string& group,
                       NoiseTerm term) {
  const auto value = CombineAxes(analysis, group, term);
  if (value) return key + ": " + FormatDigits(*value, 6) + "\n";
  if (term == NoiseTerm::kWhite)
    throw InputError("the white noise of '" + group + "' is not identifiable", key);
  return key + ": " + FormatDigits(BoundAxes(analysis, group, term), 3) +
         "   # not identifiable from this record: this is the upper bound\n";
}

}  // namespace

std::string WriteAllanJson(const AllanAnalysis& analysis) {
  Json channels = Json::array();
  for (const AllanChannel& c : analysis.channels) {
    channels.push_back({{"group", c.group},
                        {"axis", c.axis},
                        {"unit", c.unit},
                        {"mean", c.mean},
                        {"at_rest", c.unrest.empty()},
                        {"terms", TermsJson(c)},
                        {"shortest_cluster_samples", c.shortest_cluster},
                        {"worst_misfit_sd", c.fit.worst_misfit},
                        {"points", PointsJson(c, analysis.timing.period_s, analysis.confidence)}});
  }
  const Json json{{"schema", "piperun.allan/1"},
                  {"file", analysis.file},
                  {"record", TimingJson(analysis.timing)},
                  {"confidence", analysis.confidence},
                  {"at_rest", analysis.at_rest()},
                  {"notes", analysis.notes},
                  {"channels", channels}};
  return json.dump(1) + "\n";
}

void RequireKalibrGroups(const std::vector<RecordGroup>& groups) {
  for (const std::string name : {"gyro", "accel"}) {
    if (std::none_of(groups.begin(), groups.end(), [&](const RecordGroup& g) { return g.name == name; }))
      throw InputError("Kalibr's file wants gyro and accel; there is no '" + name + "'", "--kalibr");
  }
}

std::string WriteKalibrYaml(const AllanAnalysis& analysis) {
  return "# Fitted by piperun allan. Units: rad, m, s, Hz. Random walks are those of the bias.\n" +
         KalibrLine(analysis, "accelerometer_noise_density", "accel", NoiseTerm::kWhite) +
         KalibrLine(analysis, "accelerometer_random_walk", "accel", NoiseTerm::kRateRandomWalk) +
         KalibrLine(analysis, "gyroscope_noise_density", "gyro", NoiseTerm::kWhite) +
         KalibrLine(analysis, "gyroscope_random_walk", "gyro", NoiseTerm::kRateRandomWalk) +
         "rostopic: /imu0\nupdate_rate: " + FormatDigits(1 / analysis.timing.period_s, 7) + "\n";
}

}  // namespace piperun::scenarios
