// Sensors that feel pipe, stream and water: end to end, from a scenario file to the records and back.

#include <gtest/gtest.h>

#include <sstream>

#include "scenarios/assemble.h"
#include "scenarios/replay.h"
#include "tests/scenarios/small_scenario.h"

namespace piperun::scenarios {
namespace {

namespace fs = std::filesystem;

Scenario MakeIronMain(const std::string& mag) {
  std::string text = kSmallScenario;
  const auto replace = [&text](const std::string& what, const std::string& with) {
    text.replace(text.find(what), what.size(), with);
  };
  replace("material: pvc_u", "material: ductile_iron");
  replace("mag0: {kind: magnetometer, rate_Hz: 50, noise_sd_uT: 0.3}", "mag0: " + mag);
  replace("motion: {kind: ball_in_pipe}",
          "motion: {kind: ball_in_pipe}\nwall_features:\n  - {id: sticks, pipe: P1, kind: joint, spacing_m: "
          "2}\n");
  return ParseScenario(text, "iron_main.yaml", {"mission.time_limit_s=14"});
}

std::vector<std::vector<double>> ReadNumbers(const fs::path& path) {
  std::vector<std::vector<double>> rows;
  std::stringstream text(FileText(path));
  std::string line;
  std::getline(text, line);
  while (std::getline(text, line)) {
    std::stringstream fields(line);
    rows.emplace_back();
    for (std::string field; std::getline(fields, field, ',');)
      rows.back().push_back(std::strtod(field.c_str(), nullptr));
  }
  return rows;
}

TEST(IronMain, FieldFollowsTheShieldAndTheJointsAlongTheWay) {
  const TemporaryFolder folder;
  RunInto(MakeIronMain("{kind: magnetometer, rate_Hz: 100, pipe: {shield: true, joint_amplitude_uT: 30}}"),
          folder / "run");
  const auto truth = ReadNumbers(folder / "run/truth/ball.csv");  // at 100 Hz, too
  const auto mag = ReadNumbers(folder / "run/mav0/mag0/data.csv");
  // ductile iron of mu_r = 300, bore 150 mm, wall 7.5 mm, to the east
  const double ratio = 75 / 82.5, S = 1200 / (301 * 301 - 299.0 * 299 * ratio * ratio);
  const Vector3d quiet_W_T(2.6e-6, S * 25.1e-6, -S * 40.4e-6);
  ASSERT_GT(mag.size(), 500u);
  int quiet = 0;
  double largest_T = 0;
  for (std::size_t k = 0; k < mag.size(); ++k) {
    const auto& row = truth[k];
    const Vector3d m_W_T =
        Quaterniond(row[7], row[8], row[9], row[10]) * Vector3d(mag[k][1], mag[k][2], mag[k][3]);
    const double joint_m = std::abs(std::remainder(row[2], 2)), anomaly_T = (m_W_T - quiet_W_T).norm();
    if (joint_m > 0.7 || row[2] < 1 || row[2] > 5) {
      EXPECT_LT(anomaly_T, 1e-15) << row[2];
      ++quiet;
    }
    largest_T = std::max(largest_T, anomaly_T);
  }
  EXPECT_GT(quiet, 100);
  EXPECT_NEAR(largest_T, 30e-6, 0.2e-6);  // two samples are 1 cm apart: exp(-0.5 (0.5 cm / 10 cm)^2)
}

TEST(IronMain, ShieldIsOffUnlessItIsAskedFor) {
  const TemporaryFolder folder;
  RunInto(MakeIronMain("{kind: magnetometer, rate_Hz: 50}"), folder / "run");
  for (const auto& row : ReadNumbers(folder / "run/mav0/mag0/data.csv")) {
    EXPECT_NEAR(Vector3d(row[1], row[2], row[3]).norm(), Vector3d(2.6e-6, 25.1e-6, -40.4e-6).norm(), 1e-18);
  }
}

TEST(IronMain, AnomaliesWithoutJointsAreRefusedWithTheirKey) {
  const auto refused = [](const char* mag) -> std::string {
    const std::string text = std::string("sensors.mag0=") + mag;
    try {
      Assemble(MakeSmallScenario({text}));
    } catch (const InputError& e) {
      return e.key_path();
    }
    return "nothing";
  };
  EXPECT_EQ(refused("{kind: magnetometer, pipe: {joint_amplitude_uT: 5}}"),
            "sensors.mag0.pipe.joint_spacing_m");
}

TEST(Thermometer, IsWrittenAndReadBack) {
  const TemporaryFolder folder;
  RunInto(MakeSmallScenario(
              {"mission.time_limit_s=3", "water.temperature_C=8",
               "sensors.temperature0={kind: temperature, rate_Hz: 4, thermal: {time_constant_s: 2}}"}),
          folder / "run");
  const fs::path data = folder / "run/mav0/temperature0/data.csv";
  EXPECT_TRUE(FileText(data).starts_with("#timestamp [ns],temperature [C]\n"));
  const auto rows = ReadNumbers(data);
  ASSERT_EQ(rows.size(), 12u);  // the hydrophone hears 0.1 s ahead: the last one would be due at 3 s
  for (std::size_t k = 0; k < rows.size(); ++k) {
    EXPECT_EQ(rows[k][0] - rows[0][0], 2.5e8 * static_cast<double>(k));
    EXPECT_NEAR(rows[k][1], 8 + 12 * std::exp(-0.125 * static_cast<double>(k)), 1e-12);
  }
  EXPECT_NE(FileText(folder / "run/mav0/temperature0/sensor.yaml").find("sensor_type: \"temperature\""),
            std::string::npos);
  EstimatorInput input = LoadEstimatorInput((folder / "run/estimator_input.yaml").string());
  MeasurementLog log(folder / "run", input);
  std::size_t read = 0;
  while (const Measurement* m = log.Next()) {
    const auto* sample = std::get_if<TemperatureSample>(&m->value);
    if (!sample) continue;
    ASSERT_LT(read, rows.size());
    EXPECT_EQ(static_cast<double>(sample->stamp.time_since_epoch().count()), rows[read][0]);
    EXPECT_EQ(sample->temperature_C, rows[read++][1]);
  }
  EXPECT_EQ(read, rows.size());
}

}  // namespace
}  // namespace piperun::scenarios
