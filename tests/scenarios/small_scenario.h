#pragma once

#include <stdlib.h>

#include <filesystem>
#include <string>
#include <vector>

#include "base/check.h"
#include "scenarios/load.h"
#include "scenarios/output_file.h"
#include "scenarios/run.h"

namespace piperun::scenarios {

/// Six metres of straight pipe with a leak and every kind of channel: a run of a quarter of a minute.
inline constexpr char kSmallScenario[] = R"(
schema: piperun.scenario/1
name: small
seed: 7
network:
  nodes:
    - {id: A, position_m: [0, 0, 0]}
    - {id: B, position_m: [6, 0, 0]}
  pipes:
    - {id: P1, from: A, to: B, diameter_mm: 150, wall_thickness_mm: 7.5, material: pvc_u}
flow: {inlet_L_s: 8.5, inlet_pressure_bar: 3}
leaks:
  - {id: L1, pipe: P1, s_m: 3.1, hole_diameter_mm: 2}
motion: {kind: ball_in_pipe}
mission: {launch: A, retrieve: B, time_limit_s: 60}
sensors:
  imu0: {kind: imu, rate_Hz: 400, gyro: {noise_deg_s_sqrtHz: 0.01, bias_sd_deg_s: 0.05}, accel: {noise_ug_sqrtHz: 200}}
  mag0: {kind: magnetometer, rate_Hz: 50, noise_sd_uT: 0.3}
  pressure0: {kind: pressure, rate_Hz: 50, noise_sd_Pa: 100}
  temperature0: {kind: temperature, rate_Hz: 4, offset_sd_K: 0.3, noise_sd_K: 0.05}
  hydrophone0: {kind: hydrophone, rate_Hz: 16000}
  marker0: {kind: marker, jitter_sd_s: 0.1, receivers: [{pipe: P1, s_m: 3, cover_m: 1}]}
estimators:
  ekf: {kind: quaternion_ekf, locator: {kind: matched_filter}}
  thesis: {kind: quaternion_ekf, locator: {kind: envelope_peak}}
output: {truth_rate_Hz: 100}
)";

inline Scenario MakeSmallScenario(const std::vector<std::string>& overrides = {}) {
  return ParseScenario(kSmallScenario, "small.yaml", overrides);
}

/// A folder that goes away with the test.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "piperun-test-XXXXXX").string();
    Demand(::mkdtemp(name.data()) != nullptr, "the temporary folder can be created");
    path_ = name;
  }
  ~TemporaryFolder() { std::filesystem::remove_all(path_); }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

inline RunResult RunInto(const Scenario& scenario, const std::filesystem::path& out) {
  RunOptions options;
  options.out = out;
  return Run(scenario, options);
}

inline std::string FileText(const std::filesystem::path& path) { return ReadTextFile(path); }

}  // namespace piperun::scenarios
