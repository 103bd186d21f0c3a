#include "scenarios/run_json.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/check.h"
#include "scenarios/sha256.h"

namespace piperun::scenarios {
namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

Json Number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

template <class T>
Json OrNull(const std::optional<T>& value) {
  return value ? Json(*value) : Json(nullptr);
}

Json Position(const Vector3d& p) { return Json::array({Number(p.x()), Number(p.y()), Number(p.z())}); }

Json ToJson(const TrueLeak& leak) {
  return {{"id", leak.id},
          {"pipe", leak.pipe},
          {"s_m", leak.s_m},
          {"chainage_m", OrNull(leak.chainage_m)},
          {"position_m", Position(leak.p_W)},
          {"flow_m3_s", leak.flow_m3_s},
          {"t_cpa_ns", OrNull(leak.t_cpa_ns)},
          {"snr_dB", OrNull(leak.snr_dB)}};
}

Json ToJson(const std::optional<TrackScore>& score) {
  if (!score) return nullptr;
  return {{"attitude_rmse_deg", Number(score->attitude_rmse_deg)},
          {"chainage_rmse_m", Number(score->chainage_rmse_m)},
          {"chainage_final_error_m", Number(score->chainage_final_error_m)},
          {"position_rmse_m", Number(score->position_rmse_m)},
          {"position_final_error_m", Number(score->position_final_error_m)},
          {"final_error_percent", Number(score->final_error_percent)},
          {"nees_mean", Number(score->nees_mean)},
          {"nis_mean", Number(score->nis_mean)}};
}

Json ToJson(const ScoredLeak& leak) {
  return {{"chainage_m", Number(leak.estimate.chainage_m)},
          {"sigma_m", Number(leak.estimate.sigma_m)},
          {"interval_m",
           Json::array({Number(leak.estimate.interval.low_m), Number(leak.estimate.interval.high_m)})},
          {"position_m", Position(leak.estimate.p_W)},
          {"t_cpa_ns", leak.estimate.t_cpa.time_since_epoch().count()},
          {"flow_m3_s", OrNull(leak.estimate.flow_m3_s)},
          {"flow_sigma_dB", leak.estimate.flow_m3_s ? Json(leak.estimate.flow_sigma_dB) : Json()},
          {"confidence", Number(leak.estimate.confidence)},
          {"at", OrNull(leak.estimate.at)},
          {"match", OrNull(leak.match)},
          {"error_m", OrNull(leak.error_m)},
          {"covered", OrNull(leak.covered)},
          {"flow_error_dB", OrNull(leak.flow_error_dB)}};
}

Json ToJson(const EstimatorResult& result) {
  Json leaks = Json::array();
  for (const ScoredLeak& leak : result.leaks.leaks) leaks.push_back(ToJson(leak));
  return {{"causal", ToJson(result.causal)},
          {"smoothed", ToJson(result.smoothed)},
          {"leaks", leaks},
          {"missed", result.leaks.missed},
          {"false_alarms", result.leaks.false_alarms},
          {"false_alarms_at_fittings", result.leaks.false_alarms_at_fittings}};
}

Json TruthToJson(const RunResult& result) {
  Json leaks = Json::array();
  for (const TrueLeak& leak : result.leaks) leaks.push_back(ToJson(leak));
  Json truth{{"leaks", leaks}};
  if (result.contacts) {
    truth["contacts"] = {{"count", result.contacts->count},
                         {"largest_impulse_N_s", Number(result.contacts->largest_impulse_N_s)}};
  }
  return truth;
}

}  // namespace

std::string_view Version() { return PIPERUN_VERSION; }

std::map<std::string, std::string> HashFiles(const fs::path& folder) {
  std::map<std::string, std::string> hashes;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const std::string name = fs::relative(entry.path(), folder).generic_string();
    if (entry.is_regular_file() && name != "run.json") hashes[name] = Sha256OfFile(entry.path());
  }
  return hashes;
}

std::string WriteRunJson(const RunResult& result) {
  Json estimators = Json::object();
  for (const EstimatorResult& estimator : result.estimators) estimators[estimator.name] = ToJson(estimator);
  const Json json{
      {"schema", "piperun.run/1"},
      {"scenario", result.scenario},
      {"seed", result.seed},
      {"run", result.run},
      {"status", result.status},
      {"duration_s", result.duration_s},
      {"wall_s", result.wall_s},
      {"realtime_factor", Number(result.duration_s / result.wall_s)},
      {"version", Version()},
      {"route",
       {{"length_m", result.route_length_m},
        {"pipes", result.route_pipes},
        {"planned", result.planned_pipes}}},
      {"notes", result.notes},
      {"warnings", result.warnings},
      {"truth", TruthToJson(result)},
      {"estimators", estimators},
      {"hash", result.file_hashes},
  };
  return json.dump(2) + "\n";
}

RunResult LoadRunSummary(const std::string& text) {
  try {
    const Json json = Json::parse(text);
    RunResult result;
    result.scenario = json.at("scenario").get<std::string>();
    result.seed = json.at("seed").get<std::int64_t>();
    result.run = json.at("run").get<std::int64_t>();
    result.status = json.at("status").get<std::string>();
    result.duration_s = json.at("duration_s").get<double>();
    result.route_length_m = json.at("route").at("length_m").get<double>();
    result.route_pipes = json.at("route").at("pipes").get<std::vector<std::string>>();
    result.planned_pipes = json.at("route").at("planned").get<std::vector<std::string>>();
    result.notes = json.at("notes").get<std::vector<std::string>>();
    result.warnings = json.value("warnings", std::vector<std::string>{});  // older folders have none
    if (const Json::json_pointer contacts("/truth/contacts"); json.contains(contacts)) {
      result.contacts = {json.at(contacts).at("count").get<std::int64_t>(),
                         json.at(contacts).at("largest_impulse_N_s").get<double>()};
    }
    return result;
  } catch (const Json::exception& e) {
    throw InputError(std::string("this is not the run.json of a run: ") + e.what(), "", "run.json");
  }
}

JsonValue FindJson(const std::string& json, const std::string& pointer) {
  JsonValue found;
  try {
    const Json document = Json::parse(json);
    const Json& value = document.at(Json::json_pointer(pointer));
    if (value.is_number()) found.number = value.get<double>();
    if (value.is_boolean()) found.number = value.get<bool>() ? 1 : 0;
    if (value.is_string()) found.text = value.get<std::string>();
  } catch (const Json::parse_error& e) {
    throw InputError("'" + pointer + "' is not a JSON pointer", "path");
  } catch (const Json::exception&) {
    // nothing there
  }
  return found;
}

}  // namespace piperun::scenarios
