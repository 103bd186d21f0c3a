#include "scenarios/inp_scenario.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "base/number.h"
#include "scenarios/output_file.h"
#include "scenarios/pipeline.h"

namespace piperun::scenarios {
namespace {

constexpr double kBallDiameter_m = 0.06;
constexpr double kBallOverBore = 0.4;
constexpr double kLeastRadius_m = 1e-3;
constexpr double kSlowness = 3;  // time given, over the water's travel time
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

/// The file with a ball that passes every pipe, to ask where the water leads.
Scenario MakeQuestion(const std::string& inp_path, const std::string& launch, const std::string& retrieve) {
  Scenario scenario;
  scenario.network.inp = inp_path;
  scenario.network.inp_text = ReadTextFile(inp_path);
  scenario.mission.launch = launch;
  scenario.mission.retrieve = retrieve;
  scenario.ball.radius_m = kLeastRadius_m;
  return scenario;
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
  const Scenario question = MakeQuestion(inp_path, launch, retrieve);
  const Pipeline pipeline = BuildPipeline(question, CalcWater(question.water.temperature_C));
  InpScenarioPlan plan{inp_path, ReadableName(inp_path), launch, retrieve, kBallDiameter_m, 0, {}, 0};
  double longest_m = 0, travel_s = 0;
  for (const RouteLeg& leg : pipeline.plan) {
    const Pipe& pipe = pipeline.network.pipe(leg.pipe);
    const double middle_m = 0.5 * pipe.length_m;
    travel_s += pipe.length_m / std::abs(pipeline.flow.Eval(leg.pipe, middle_m, TrueTime{}).velocity_m_s);
    plan.ball_diameter_m = std::min(plan.ball_diameter_m, kBallOverBore * pipe.diameter_m);
    if (pipe.length_m <= longest_m) continue;
    longest_m = pipe.length_m;
    plan.leak_pipe = pipe.id;
    plan.leak_s_m = std::round(5 * longest_m) / 10;
  }
  plan.time_limit_s = std::ceil(kShortestRun_s + kSlowness * travel_s);
  return plan;
}

}  // namespace piperun::scenarios
