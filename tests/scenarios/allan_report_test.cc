#include "scenarios/allan_report.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "base/check.h"
#include "base/random.h"
#include "scenarios/output_file.h"
#include "scenarios/reproduction.h"
#include "scenarios/sensor_presets.h"
#include "sim/imu_error.h"
#include "sim/imu_params.h"
#include "tests/scenarios/small_scenario.h"

namespace piperun::scenarios {
namespace {

using estimator::Index;
using estimator::NoiseTerm;

/// A record in memory: white noise on gyro (1.7e-4 rad/s/sqrt(Hz)) and accel (2e-3), at 100 Hz, gravity on z;
/// `disturb` may change sample k.
class MemoryRecord : public StaticRecord {
 public:
  using Disturb = void (*)(std::int64_t k, Vector3d& gyro, Vector3d& accel);
  explicit MemoryRecord(std::int64_t samples, Disturb disturb = nullptr)
      : samples_(samples), disturb_(disturb) {
    timing_.period_s = 0.01;
    timing_.rows = samples;
  }
  const std::vector<RecordGroup>& groups() const override { return groups_; }
  const RecordTiming& timing() const override { return timing_; }
  double progress() const override { return 0; }
  bool Next(RecordBlock& block) override {
    block.starts_segment = next_ == 0;
    block.channels.assign(6, {});
    for (const std::int64_t end = std::min(samples_, next_ + 5000); next_ < end; ++next_) {
      const auto k = static_cast<std::uint64_t>(next_);
      const auto g = random_.Normals(k, 0), a = random_.Normals(k, 1);
      Vector3d gyro = 1.7e-3 * Vector3d(g[0], g[1], g[2]), accel = 0.02 * Vector3d(a[0], a[1], a[2]);
      accel.z() += 9.80665;
      if (disturb_) disturb_(next_, gyro, accel);
      for (std::size_t i = 0; i < 3; ++i) {
        block.channels[i].push_back(gyro[static_cast<Eigen::Index>(i)]);
        block.channels[3 + i].push_back(accel[static_cast<Eigen::Index>(i)]);
      }
    }
    return !block.channels[0].empty();
  }

 private:
  std::int64_t samples_, next_ = 0;
  Disturb disturb_;
  RandomStream random_{5, "memory", 0};
  RecordTiming timing_;
  std::vector<RecordGroup> groups_{{"gyro", "rad/s", {"x", "y", "z"}}, {"accel", "m/s^2", {"x", "y", "z"}}};
};

AllanAnalysis Analyse(std::int64_t samples, MemoryRecord::Disturb disturb = nullptr) {
  MemoryRecord record(samples, disturb);
  return AnalyseStaticRecord(record, "memory", {});
}

TEST(AllanReport, ARestingSensorIsSaidToRest) {
  const AllanAnalysis analysis = Analyse(200000);
  EXPECT_TRUE(analysis.at_rest());
  EXPECT_TRUE(analysis.notes.empty()) << analysis.notes.front();
  // three axes, relative sd of N of each about 0.4 % at 200,000 samples and 5 terms
  EXPECT_NEAR(CombineAxes(analysis, "gyro", NoiseTerm::kWhite).value() / 1.7e-4, 1, 0.008);
  EXPECT_NEAR(CombineAxes(analysis, "accel", NoiseTerm::kWhite).value() / 2e-3, 1, 0.008);
  EXPECT_FALSE(CombineAxes(analysis, "gyro", NoiseTerm::kRateRandomWalk));
}

TEST(AllanReport, MotionIsSaidSlow) {
  const AllanAnalysis knocked = Analyse(60000, [](std::int64_t k, Vector3d& gyro, Vector3d&) {
    if (k >= 30000 && k < 30100) gyro.x() += k % 2 ? 0.02 : -0.02;
  });
  EXPECT_FALSE(knocked.at_rest());
  EXPECT_NE(knocked.notes.front().find("shaken"), std::string::npos);
  const AllanAnalysis tilted = Analyse(60000, [](std::int64_t k, Vector3d&, Vector3d& accel) {
    if (k >= 30000) accel.x() += 0.5;
  });
  EXPECT_FALSE(tilted.at_rest());
  EXPECT_NE(tilted.notes.front().find("jumped"), std::string::npos);
  const AllanAnalysis rolling =
      Analyse(60000, [](std::int64_t, Vector3d& gyro, Vector3d&) { gyro.y() += 30; });
  EXPECT_NE(rolling.notes.front().find("it turns"), std::string::npos);
}

TEST(AllanReport, EveryNoiseOfTheSimulatorRests) {
  // no false alarm by flicker and random walk, however strong
  for (const double walk : {0.0, 1.0}) {
    sim::TriadErrorParams params;
    params.bias_instability = 1 - walk;
    params.rate_random_walk = walk;
    const sim::TriadStream stream{RandomStream(2, "rest", 0), 0};
    const auto c = sim::MakeCoefficients(params, Rate(100), stream);
    auto state = sim::MakeState(c, stream);
    RestCheck check(0.01);
    for (std::int64_t k = 0; k < 300000; ++k)
      check.Append(std::vector<double>{StepError(state, k, stream, c).x()});
    EXPECT_TRUE(JudgeRest(check.Findings(), "accel").empty()) << JudgeRest(check.Findings(), "accel").front();
  }
}

TEST(AllanReport, JsonHoldsNoNumberThatIsNotIdentifiable) {
  const auto json = nlohmann::json::parse(WriteAllanJson(Analyse(50000)));
  EXPECT_EQ(json["schema"], "piperun.allan/1");
  EXPECT_EQ(json["channels"].size(), 6U);
  for (const auto& channel : json["channels"]) {
    EXPECT_TRUE(channel["terms"]["N"]["identifiable"]);
    EXPECT_NEAR(channel["terms"]["N"]["value"].get<double>(), channel["group"] == "gyro" ? 1.7e-4 : 2e-3,
                channel["group"] == "gyro" ? 5e-6 : 6e-5);
    EXPECT_TRUE(channel["terms"]["K"]["value"].is_null());
    for (const auto& point : channel["points"]) {
      EXPECT_LE(point["low"].get<double>(), point["deviation"].get<double>());
      EXPECT_TRUE(point["high"].is_null() || point["high"] >= point["deviation"]);
    }
  }
}

TEST(AllanReport, KalibrFileHasItsKeysAndSaysWhereItBounds) {
  const std::string yaml = WriteKalibrYaml(Analyse(50000));
  const auto value = [&](const std::string& key) {
    const std::size_t at = yaml.find("\n" + key + ": ");
    return at == std::string::npos ? -1 : std::stod(yaml.substr(at + key.size() + 3));
  };
  EXPECT_NEAR(value("accelerometer_noise_density"), 2e-3, 3e-5);
  EXPECT_NEAR(value("gyroscope_noise_density"), 1.7e-4, 3e-6);
  EXPECT_GT(value("accelerometer_random_walk"), 0);
  EXPECT_GT(value("gyroscope_random_walk"), 0);
  EXPECT_NEAR(value("update_rate"), 100, 1e-6);
  EXPECT_NE(yaml.find("# not identifiable from this record: this is the upper bound"), std::string::npos);
}

/// Three gyroscope axes with every term found, but for the random walk; the values are those of axis 0, the
/// others differ by 2 % up and down.
AllanAnalysis FittedGyroscope() {
  AllanAnalysis analysis;
  analysis.timing.period_s = 0.005;
  for (const double factor : {1.0, 1.02, 0.98}) {
    AllanChannel channel;
    channel.group = "gyro";
    channel.unit = "rad/s";
    const auto set = [&](NoiseTerm term, double value) {
      channel.fit.terms[Index(term)] = {factor * value, {0.9 * value, 1.1 * value}, true};
    };
    set(NoiseTerm::kQuantisation, 1e-6);
    set(NoiseTerm::kWhite, 2e-4);
    set(NoiseTerm::kFlicker, 5e-5);
    set(NoiseTerm::kRamp, 3e-9);
    set(NoiseTerm::kGaussMarkov, 4e-5);
    channel.fit.terms[Index(NoiseTerm::kRateRandomWalk)] = {0, {0, 7e-7}, false};
    channel.fit.gauss_markov_time_s = {factor * 20, {15, 25}, true};
    analysis.channels.push_back(channel);
  }
  return analysis;
}

TEST(AllanReport, APresetReadsBackWithEveryTerm) {
  const TemporaryFolder folder;
  WriteTextFile(folder / "mine.yaml", WriteSensorPreset(FittedGyroscope()));
  const SensorPreset preset = LoadSensorPreset("mine.yaml", folder.path());
  const auto& imu = dynamic_cast<const sim::ImuParams&>(preset.Find("imu")->params());
  const double rms = std::sqrt((1 + 1.02 * 1.02 + 0.98 * 0.98) / 3);
  constexpr double kDigits = 1e-5;  // relative: six digits are written
  EXPECT_NEAR(imu.rate_Hz, 200, 1e-4);
  EXPECT_NEAR(imu.gyro.quantisation / (rms * 1e-6), 1, kDigits);
  EXPECT_NEAR(imu.gyro.noise / (rms * 2e-4), 1, kDigits);
  EXPECT_NEAR(imu.gyro.bias_instability / (rms * 5e-5), 1, kDigits);
  EXPECT_NEAR(imu.gyro.gauss_markov_sd / (rms * 4e-5), 1, kDigits);
  EXPECT_NEAR(imu.gyro.gauss_markov_time_s / (20 * std::cbrt(1.02 * 0.98)), 1, kDigits);
  for (const double ramp : imu.gyro.rate_ramp) EXPECT_NEAR(ramp / (rms * 3e-9), 1, kDigits);
  EXPECT_EQ(imu.gyro.rate_random_walk, 0) << "not identifiable";
  EXPECT_EQ(imu.accel.noise, 0) << "not in the record";
  EXPECT_NE(ReadTextFile(folder / "mine.yaml")
                .find("rate_random_walk_rad_s2_sqrtHz: not identifiable from "
                      "this record, below 7e-07"),
            std::string::npos);
}

TEST(AllanReport, APresetWithoutInertialSensorsIsRefused) {
  AllanAnalysis analysis = FittedGyroscope();
  for (AllanChannel& channel : analysis.channels) channel.group = "mag";
  EXPECT_THROW(WriteSensorPreset(analysis), InputError);
}

TEST(AllanReport, PlotIsDrawnForBothGroups) {
  const std::string svg = DrawAllanSvg(Analyse(20000));
  EXPECT_NE(svg.find("gyro: Allan deviation, rad/s"), std::string::npos);
  EXPECT_NE(svg.find("accel: Allan deviation, m/s^2"), std::string::npos);
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  EXPECT_EQ(svg.find("inf"), std::string::npos);
}

TEST(AllanReport, TenSamplesAreTooFew) { EXPECT_THROW(Analyse(10), InputError); }

TEST(AllanReport, StudyFindsWhatWasPutInSlow) {
  for (const Reproduction& study : Reproductions()) {
    if (study.name != "allan") continue;
    ReproduceOptions options;
    options.size = 0.05;
    options.jobs = 2;
    for (const ReproducedFigure& figure : study.run(options).figures) {
      EXPECT_TRUE(figure.passed) << figure.what << ": " << figure.measured << ", expected "
                                 << figure.expected;
    }
  }
}

}  // namespace
}  // namespace piperun::scenarios
