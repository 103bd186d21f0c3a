#include "scenarios/sensor_presets.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <sstream>

#include "scenarios/embedded.h"
#include "scenarios/physical_unit.h"
#include "scenarios/reference.h"
#include "scenarios/reproduction.h"
#include "scenarios/rest_record.h"
#include "scenarios/rest_recording.h"
#include "sim/imu_params.h"
#include "tests/scenarios/small_scenario.h"

namespace piperun::scenarios {
namespace {

InputError ErrorOf(const std::function<void()>& action) {
  try {
    action();
  } catch (const InputError& e) {
    return e;
  }
  ADD_FAILURE() << "no error";
  return InputError("");
}

Scenario WithSensors(const std::string& sensors) {
  return MakeSmallScenario({"sensors=" + sensors, "estimators={}"});
}

const sim::ImuParams& ImuOf(const Scenario& scenario) {
  return dynamic_cast<const sim::ImuParams&>(scenario.sensors.front().kind.params());
}

const sim::ImuParams& ImuOf(const std::string& preset) {
  for (const SensorPreset& board : SensorPresets()) {
    if (board.name == preset) return dynamic_cast<const sim::ImuParams&>(board.Find("imu")->params());
  }
  throw InputError("no preset " + preset);
}

double Si(double value, std::string_view unit) { return ConvertToSi(value, unit, {}).value; }

TEST(SensorPresets, ABoardIsWhereTheFileBegins) {
  const Scenario plain = WithSensors("{imu0: {kind: imu, preset: mpu_9250}}");
  EXPECT_DOUBLE_EQ(ImuOf(plain).rate_Hz, 200);
  EXPECT_DOUBLE_EQ(ImuOf(plain).accel.filter.digital_bandwidth_Hz, 94);
  const Scenario changed = WithSensors(
      "{imu0: {gyro: {noise_deg_s_sqrtHz: 0.02, range_rad_s: none}, preset: mpu_9250, kind: imu, rate_Hz: "
      "50}}");
  EXPECT_DOUBLE_EQ(ImuOf(changed).rate_Hz, 50) << "what the file says counts, wherever it stands";
  EXPECT_DOUBLE_EQ(ImuOf(changed).gyro.noise, 0.02 * std::numbers::pi / 180);
  EXPECT_FALSE(ImuOf(changed).gyro.range);
  EXPECT_DOUBLE_EQ(ImuOf(changed).gyro.bias_sd, 1.67 * std::numbers::pi / 180) << "the rest is the board's";
}

TEST(SensorPresets, TheEffectiveScenarioReadsBackToTheSameBytes) {
  for (const SensorPreset& preset : SensorPresets()) {
    for (const KindEntry& section : preset.sections) {
      const std::string written = WriteScenario(
          WithSensors("{s: {kind: " + section.kind() + ", preset: " + preset.name + ", rate_Hz: 37}}"));
      const Scenario again = ParseScenario(written, "again.yaml");
      EXPECT_EQ(again.sensors.front().preset, preset.name);
      EXPECT_EQ(WriteScenario(again), written) << preset.name << " " << section.kind();
    }
  }
}

TEST(SensorPresets, AFileOfTheUsersIsWrittenOutAndRunsAnywhere) {
  const TemporaryFolder folder;
  WriteTextFile(folder / "mine.yaml",
                "name: mine\ndescription: my own\nimu: {rate_Hz: 125, gyro: {noise_deg_s_sqrtHz: 0.5}}\n");
  WriteTextFile(folder / "run.yaml",
                "schema: piperun.scenario/1\nname: run\n"
                "sensors: {imu0: {kind: imu, preset: mine.yaml, accel: {noise_ug_sqrtHz: 7}}}\n");
  const Scenario scenario = LoadScenario((folder / "run.yaml").string());
  EXPECT_EQ(ImuOf(scenario).rate_Hz, 125);
  EXPECT_DOUBLE_EQ(ImuOf(scenario).gyro.noise, 0.5 * std::numbers::pi / 180);
  const std::string written = WriteScenario(scenario);
  const Scenario elsewhere = ParseScenario(written, "/nowhere/else.yaml");
  EXPECT_EQ(WriteScenario(elsewhere), written);
  EXPECT_EQ(ImuOf(elsewhere).gyro.noise, ImuOf(scenario).gyro.noise);
}

TEST(SensorPresets, AWrongValueInAFileOfTheUsersIsSaidWithItsLine) {
  const TemporaryFolder folder;
  const std::string file = (folder / "mine.yaml").string();
  WriteTextFile(file, "name: mine\ndescription: my own\nimu:\n  gyro: {noise_deg_s_sqrtHz: -1}\n");
  const InputError e = ErrorOf([&] { WithSensors("{imu0: {kind: imu, preset: " + file + "}}"); });
  EXPECT_EQ(e.where(), file + ":4");
  EXPECT_EQ(e.key_path(), "imu.gyro.noise_deg_s_sqrtHz");
  WriteTextFile(file, "name: mine\ndescription: nothing\n");
  EXPECT_NE(ErrorOf([&] { LoadSensorPreset(file, {}); }).problem().find("needs a section"),
            std::string::npos);
}

TEST(SensorPresets, AnUnknownNameIsCorrectedWithTheList) {
  const auto read = [] {
    ParseScenario("schema: piperun.scenario/1\nname: x\nsensors:\n  a:\n    kind: imu\n    preset: mpu_925\n",
                  "x.yaml");
  };
  const InputError e = ErrorOf(read);
  EXPECT_EQ(e.where(), "x.yaml:6");
  EXPECT_EQ(e.key_path(), "sensors.a.preset");
  EXPECT_NE(e.problem().find("did you mean 'mpu_9250'?"), std::string::npos) << e.problem();
  for (const SensorPreset& preset : SensorPresets())
    EXPECT_NE(e.problem().find(" " + preset.name), std::string::npos) << preset.name;
}

TEST(SensorPresets, AKindThatTheBoardLacksIsRefusedWithThoseItHas) {
  const InputError e = ErrorOf([] { WithSensors("{m: {kind: magnetometer, preset: bmi088}}"); });
  EXPECT_EQ(e.key_path(), "sensors.m.preset");
  EXPECT_EQ(e.problem(), "the preset 'bmi088' has no magnetometer; it has: imu");
}

TEST(SensorPresets, TheReferenceListsThem) {
  const std::string reference = WriteReference();
  for (const SensorPreset& preset : SensorPresets())
    EXPECT_NE(reference.find("- `" + preset.name + "` (" + preset.Kinds() + "): "), std::string::npos)
        << preset.name;
}

// Values worked out by hand from the sheets' own units, beside what the unit converter makes of them.
TEST(SensorPresets, DataSheetUnitsAreConvertedOnce) {
  constexpr double kDegree = std::numbers::pi / 180, g = 9.80665;
  // STIM300: 0.15 deg/sqrt(h) = 0.15 / 60 deg/s/sqrt(Hz); NavToolkit prints 4.3633e-5 rad/sqrt(s) for it
  const double arw = ImuOf("stim300").gyro.noise;
  EXPECT_NEAR(arw, 4.3633e-5, 5e-10);
  EXPECT_NEAR(arw / Si(0.15, "deg/sqrt(h)"), 1, 1e-12);
  // and 0.06 m/s/sqrt(h) = 1e-3 m/s^2/sqrt(Hz), kept as 102 ug/sqrt(Hz): three digits
  EXPECT_NEAR(ImuOf("stim300").accel.noise / 1e-3, 1, 5e-3);
  EXPECT_NEAR(Si(0.06, "m/s/sqrt(h)"), 1e-3, 1e-15);
  // MPU-9250: 300 ug/sqrt(Hz); +-0.026 %/degC over three
  EXPECT_NEAR(ImuOf("mpu_9250").accel.noise, 300e-6 * g, 1e-15);
  EXPECT_NEAR(ImuOf("mpu_9250").accel.noise / Si(300, "ug/sqrt(Hz)"), 1, 1e-12);
  EXPECT_NEAR(ImuOf("mpu_9250").accel.temperature_scale.x() / (2.6e-4 / 3), 1, 5e-3);
  // ADIS16470: 8 deg/h = 3.8785e-5 rad/s on the floor of the Allan deviation, sqrt(2 ln 2 / pi) B
  const double floor =
      std::sqrt(2 * std::numbers::ln2 / std::numbers::pi) * ImuOf("adis16470").gyro.bias_instability;
  EXPECT_NEAR(floor / 3.8785e-5, 1, 1e-3);
  EXPECT_NEAR(floor / Si(8, "deg/h"), 1, 1e-3);
  // L3GD20H: 70 mdps per digit; LSM303D: 0.732 mg per LSB
  EXPECT_NEAR(ImuOf("source_d").gyro.resolution / Si(70, "mdps"), 1, 1e-12);
  EXPECT_NEAR(ImuOf("source_d").accel.resolution, 0.732e-3 * g, 1e-15);
  // a board's register holds its range in 16 bits
  EXPECT_NEAR(ImuOf("source_a").gyro.resolution, 2000 * kDegree / 32768, 1e-15);
  EXPECT_NEAR(ImuOf("bmi088").accel.resolution, 24 * g / 32768, 1e-15);
}

TEST(SensorPresets, NonlinearityIsWhatTheBestStraightLineLeaves) {
  // s2 |x| x less c x on [0, FS], c where the two largest departures are alike, found by trial
  const sim::TriadErrorParams& gyro = ImuOf("mpu_9250").gyro;
  const double FS = *gyro.range, s2 = gyro.scale_second_order.x();
  double least = INFINITY;
  for (int i = 0; i <= 1000; ++i) {
    const double c = s2 * FS * i / 1000;
    double worst = 0;
    for (int k = 0; k <= 1000; ++k) {
      const double x = FS * k / 1000;
      worst = std::max(worst, std::abs(s2 * x * x - c * x));
    }
    least = std::min(least, worst);
  }
  EXPECT_NEAR(least / FS, 1e-3, 1e-5) << "+-0.1 %";
}

TEST(SensorPresets, SourceAHasItsMeasuredOffsetAndVariance) {
  const sim::ImuParams& imu = ImuOf("source_a");
  const Vector3d offset_deg_s(-0.1342, -0.0553, 0.1455);
  EXPECT_LT((imu.gyro.bias * 180 / std::numbers::pi - offset_deg_s).norm(), 1e-12);
  const double sd_deg_s = imu.gyro.noise * std::sqrt(imu.rate_Hz) * 180 / std::numbers::pi;
  EXPECT_NEAR(sd_deg_s * sd_deg_s, (0.0705 + 0.0732 + 0.0663) / 3, 1e-4);
}

TEST(SensorPresets, AnIdealSensorReadsTheTruth) {
  const auto record = SimulateStaticRecord(LoadRestScenario("ideal", {1, {}, {}}), "imu0", 1);
  RecordBlock block;
  ASSERT_TRUE(record->Next(block));
  EXPECT_EQ(block.channels[0].size(), 400U);
  for (std::size_t i = 0; i < 400; ++i) {
    EXPECT_EQ(block.channels[0][i], 0);
    EXPECT_NEAR(block.channels[5][i], 9.80665, 1e-12);
  }
}

/// Lines that give a value and have no comment, on the line or above it.
std::vector<std::string> ValuesWithoutSource(std::string_view yaml) {
  std::vector<std::string> bare;
  std::istringstream lines{std::string(yaml)};
  bool above = false, sections = false;
  for (std::string line; std::getline(lines, line);) {
    const std::size_t first = line.find_first_not_of(' ');
    sections |= line.starts_with("imu:");
    const bool comment = first != std::string::npos && line[first] == '#';
    const bool value =
        line.find(": ") != std::string::npos && line.find_first_of("0123456789") != std::string::npos;
    if (sections && value && !comment && !above && line.find(" # ") == std::string::npos)
      bare.push_back(line);
    above = comment;
  }
  return bare;
}

TEST(SensorPresets, EveryValueHasItsSource) {
  EXPECT_EQ(ValuesWithoutSource("imu:\n  rate_Hz: 3\n").size(), 1U);
  for (const EmbeddedFile& file : EmbeddedSensors()) {
    for (const std::string& line : ValuesWithoutSource(file.text)) ADD_FAILURE() << file.name << ": " << line;
  }
}

TEST(SensorPresets, EveryBoardRecordsAtRestAtItsRates) {
  for (const SensorPreset& preset : SensorPresets()) {
    const TemporaryFolder folder;
    const Scenario scenario = LoadRestScenario(preset.name, {5, {}, {}});
    ASSERT_EQ(scenario.sensors.size(), preset.sections.size());
    RunOptions options;
    options.out = folder / "rest";
    for (const RestChannel& channel : RecordRest(scenario, 5, options)) {
      EXPECT_GE(channel.samples, 5 * 50) << preset.name << " " << channel.name;
      EXPECT_EQ(channel.lost, 0);
    }
  }
}

TEST(SensorPresets, EveryBoardRidesInABall) {
  for (const SensorPreset& preset : SensorPresets()) {
    std::string sensors;
    for (const KindEntry& s : preset.sections)
      sensors += (sensors.empty() ? "" : ", ") + s.kind() + "0: {kind: " + s.kind() +
                 ", preset: " + preset.name + "}";
    const TemporaryFolder folder;
    EXPECT_EQ(RunInto(WithSensors("{" + sensors + "}"), folder / "run").status, "ok") << preset.name;
  }
}

TEST(RestRecording, InMemoryIsWhatTheRunFolderHolds) {
  const TemporaryFolder folder;
  const Scenario scenario =
      LoadRestScenario("xsens_mtw2", {20, {}, {"sensors.imu0.sampling.loss_probability=0.01"}});
  RunOptions options;
  options.out = folder / "rest";
  RecordRest(scenario, 20, options);
  const auto in_memory = SimulateStaticRecord(scenario, "imu0", 20);
  const auto written = OpenStaticRecord(folder / "rest", {});
  std::vector<std::vector<double>> a(6), b(6);
  int a_segments = 0;
  const auto read = [](StaticRecord& record, std::vector<std::vector<double>>& all, int& segments) {
    for (RecordBlock block; record.Next(block);) {
      segments += block.starts_segment;
      for (std::size_t i = 0; i < 6; ++i)
        all[i].insert(all[i].end(), block.channels[i].begin(), block.channels[i].end());
    }
  };
  int b_segments = 0;
  read(*in_memory, a, a_segments);
  read(*written, b, b_segments);
  EXPECT_EQ(a, b) << "written decimals read back to the same bits";
  EXPECT_LT(a[0].size(), 2000U) << "some were lost";
  EXPECT_GT(a_segments, 1);
  EXPECT_EQ(a_segments, b_segments);
}

TEST(RestRecording, ASensorThatIsNotThereIsRefused) {
  const Scenario scenario = LoadRestScenario("mpu_9250", {1, {}, {}});
  EXPECT_EQ(ErrorOf([&] { SimulateStaticRecord(scenario, "imu1", 1); }).key_path(), "sensors.imu1");
  EXPECT_EQ(ErrorOf([&] { SimulateStaticRecord(scenario, "mag0", 1); }).key_path(), "sensors.mag0");
}

TEST(SensorPresets, TheStudyFindsTheDataSheetsSlow) {
  for (const Reproduction& study : Reproductions()) {
    if (study.name != "sensors") continue;
    const TemporaryFolder folder;
    ReproduceOptions options;
    options.size = 0.05;
    options.jobs = 2;
    options.out = folder / "plots";
    const ReproduceReport report = study.run(options);
    EXPECT_EQ(report.figures.size(), SensorPresets().size());
    for (const ReproducedFigure& figure : report.figures)
      EXPECT_TRUE(figure.passed) << figure.what << ": " << figure.measured << " of " << figure.expected;
    EXPECT_NE(ReadTextFile(folder / "plots/mpu_9250.svg").find("<svg"), std::string::npos);
  }
}

}  // namespace
}  // namespace piperun::scenarios
