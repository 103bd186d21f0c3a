#include "scenarios/inp_scenario.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "base/check.h"
#include "base/number.h"
#include "scenarios/nearest_name.h"
#include "scenarios/network_params.h"
#include "scenarios/output_file.h"
#include "sim/network/inp_reader.h"

namespace piperun::scenarios {
namespace {

constexpr double kBallDiameter_m = 0.06;
constexpr double kBallOverBore = 0.4;
constexpr double kSlowestBall_m_s = 0.05;
constexpr double kShortestRun_s = 600;

/// A YAML scalar that reads back as this text, whatever is in it.
std::string Quoted(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? "''" : std::string(1, c);
  return quoted + "'";
}

std::string LeakText(const InpScenarioPlan& plan) {
  if (plan.leak_pipe.empty()) return "leaks: []\n";
  return "leaks:\n  - {id: L1, pipe: " + Quoted(plan.leak_pipe) + ", s_m: " + FormatNumber(plan.leak_s_m) +
         ", hole_diameter_mm: 3}\n";
}

constexpr const char* kInstruments = R"(sensors:
  imu0:
    kind: imu
    rate_Hz: 400
    gyro: {noise_deg_s_sqrtHz: 0.01, bias_sd_deg_s: 0.05, bias_instability_deg_h: 10, scale_error_sd: 0.001, range_deg_s: 2000}
    accel: {noise_ug_sqrtHz: 200, bias_sd_mg: 2, bias_instability_ug: 40, scale_error_sd: 0.001, range_m_s2: 156.9064}
  mag0: {kind: magnetometer, rate_Hz: 50, noise_sd_uT: 0.3}
  pressure0: {kind: pressure, rate_Hz: 50, noise_sd_Pa: 100, offset_sd_Pa: 500}
  hydrophone0: {kind: hydrophone, rate_Hz: 16000}
estimators:
  ekf: {kind: quaternion_ekf, locator: {kind: matched_filter}}
output: {truth_rate_Hz: 100}
)";

std::string ReadableName(const std::string& inp_path) {
  return std::filesystem::path(inp_path).stem().string();
}

int FindNode(const Network& network, const std::string& id, const std::string& key) {
  if (const auto node = network.FindNode(id)) return *node;
  std::vector<std::string> known;
  for (const NodeSpec& node : network.nodes()) known.push_back(node.id);
  const auto near = FindNearestName(id, known);
  throw InputError(
      "there is no node '" + id + "' in this file" + (near ? "; did you mean '" + *near + "'?" : ""), key);
}

}  // namespace

std::string MakeInpScenario(const InpScenarioPlan& plan) {
  return "# Made by `piperun scenario new --inp`; every key is explained by `piperun scenario reference`.\n"
         "schema: piperun.scenario/1\n"
         "name: " +
         Quoted(plan.name) +
         "\n"
         "description: " +
         Quoted("From " + plan.launch + " to " + plan.retrieve + " through " + plan.name) +
         "\n"
         "seed: 1\n"
         "water: {temperature_C: 12}\n"
         "network: {inp: " +
         Quoted(plan.inp_path) + "}   # heads and flows come from this file, too\n" + LeakText(plan) +
         "motion: {kind: ball_in_pipe}\n"
         "ball: {radius_mm: " +
         FormatNumber(500 * plan.ball_diameter_m) +
         ", density_kg_m3: 1100}\n"
         "mission: {launch: " +
         Quoted(plan.launch) + ", retrieve: " + Quoted(plan.retrieve) +
         ", time_limit_s: " + FormatNumber(plan.time_limit_s) + "}\n" + kInstruments;
}

InpScenarioPlan PlanInpScenario(const std::string& inp_path, const std::string& launch,
                                const std::string& retrieve) {
  const sim::HydraulicModel model = sim::ReadInp(ReadTextFile(inp_path), inp_path);
  const Network network = MakeNetwork(DrawNetwork(model, DrawingParams{}).network);
  const Route route =
      FindRoute(network, FindNode(network, launch, "--from"), FindNode(network, retrieve, "--to"));
  InpScenarioPlan plan{inp_path, ReadableName(inp_path), launch, retrieve, kBallDiameter_m, 0, {}, 0};
  double longest_m = 0;
  for (const RouteLeg& leg : route.legs()) {
    const Pipe& pipe = network.pipe(leg.pipe);
    plan.ball_diameter_m = std::min(plan.ball_diameter_m, kBallOverBore * pipe.diameter_m);
    if (pipe.length_m <= longest_m) continue;
    longest_m = pipe.length_m;
    plan.leak_pipe = pipe.id;
    plan.leak_s_m = std::round(5 * longest_m) / 10;
  }
  plan.ball_diameter_m = std::floor(1000 * plan.ball_diameter_m) / 1000;
  plan.time_limit_s = std::max(kShortestRun_s, 60 * std::ceil(route.length_m() / kSlowestBall_m_s / 60));
  return plan;
}

}  // namespace piperun::scenarios
