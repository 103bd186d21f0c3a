#include "scenarios/correlate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "acoustics/audio_file.h"
#include "acoustics/inverse_fft.h"
#include "base/check.h"
#include "base/random.h"
#include "tests/scenarios/small_scenario.h"

namespace piperun::scenarios {
namespace {

namespace fs = std::filesystem;

constexpr double kRate_Hz = 8000, kDistance_m = 100, kLeak_m = 30, kSpeed_m_s = 1250;
constexpr std::size_t kSamples = 1 << 17;  // 16 s

/// What two sensors hear of a leak between them, 100 to 1500 Hz, in as much noise of their own.
class TwoSensors : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TemporaryFolder();
    Write("a.wav", Hear(kLeak_m, 1, 1), kRate_Hz);
    Write("b.wav", Hear(kDistance_m - kLeak_m, 1, 2), kRate_Hz);
    Write("noise.wav", Hear(0, 0, 3), kRate_Hz);
    Write("fast.wav", Hear(0, 1, 3), 2 * kRate_Hz);
    Write("silent.wav", std::vector<std::int32_t>(kSamples), kRate_Hz);
    std::vector<std::int32_t> brief = Hear(kLeak_m, 1, 1);
    brief.resize(3000);
    Write("brief.wav", brief, kRate_Hz);
  }
  static void TearDownTestSuite() { delete folder_; }

  static std::vector<std::int32_t> Hear(double way_m, double level, std::uint64_t own) {
    const RandomStream leak(1, "leak", 0), noise(own, "noise", 0);
    std::vector<std::complex<float>> spectrum(kSamples / 2 + 1);
    for (std::size_t k = 1; k + 1 < spectrum.size(); ++k) {
      const double f_Hz = kRate_Hz / kSamples * static_cast<double>(k);
      const auto z = leak.Normals(k, 0), n = noise.Normals(k, 0);
      const double share = f_Hz > 100 && f_Hz < 1500 ? level : 0;
      const auto delayed = share * std::complex<double>(z[0], z[1]) *
                           std::polar(1.0, -2 * std::numbers::pi * f_Hz * way_m / kSpeed_m_s);
      spectrum[k] = std::complex<float>(delayed + std::complex<double>(n[0], n[1]));
    }
    std::vector<float> signal(kSamples);
    acoustics::InverseRealFft(kSamples).Transform(spectrum, signal);
    std::vector<std::int32_t> counts;
    for (const float x : signal) counts.push_back(static_cast<std::int32_t>(5 * x));
    return counts;
  }
  static void Write(const char* name, const std::vector<std::int32_t>& counts, double rate_Hz) {
    acoustics::AudioWriter writer(*folder_ / name,
                                  {acoustics::AudioContainer::kWav, std::llround(rate_Hz), 16});
    writer.Write(counts);
    writer.Close();
  }
  static CorrelateOptions Of(const char* a, const char* b) {
    CorrelateOptions options;
    options.audio = {*folder_ / a, *folder_ / b};
    options.distance_m = kDistance_m;
    options.distance_sd_m = 0;
    options.speed_m_s = kSpeed_m_s;
    options.speed_sd = 0;
    options.band_low_Hz = 100;
    options.band_high_Hz = 1500;
    return options;
  }
  static std::string Problem(const CorrelateOptions& options) {
    try {
      Correlate(options);
    } catch (const InputError& e) {
      return e.what();
    }
    return "";
  }
  static TemporaryFolder* folder_;
};
TemporaryFolder* TwoSensors::folder_ = nullptr;

TEST_F(TwoSensors, FindTheLeakBetweenThem) {
  const Correlation found = Correlate(Of("a.wav", "b.wav"));
  ASSERT_TRUE(found.delay.correlated);
  EXPECT_LT(found.leak.sigma_m, 0.02);
  EXPECT_NEAR(found.leak.from_a_m, kLeak_m, 4 * found.leak.sigma_m);
  const auto json = nlohmann::json::parse(WriteCorrelationJson(found));
  EXPECT_EQ(json["from_a_m"], found.leak.from_a_m);
  EXPECT_EQ(json["correlated"], true);
  EXPECT_NE(DrawCorrelationSvg(found).find("</svg>"), std::string::npos);
}

TEST_F(TwoSensors, TheOtherWayRoundItIsAsFarFromTheOtherSensor) {
  const Correlation found = Correlate(Of("b.wav", "a.wav"));
  EXPECT_NEAR(found.leak.from_a_m, kDistance_m - kLeak_m, 4 * found.leak.sigma_m);
}

TEST_F(TwoSensors, TakeTheSpeedFromThePipe) {
  CorrelateOptions options = Of("a.wav", "b.wav");
  options.speed_m_s.reset();
  options.pipe = {"ductile_iron", 0.158, 0.006, 10};
  EXPECT_NEAR(Correlate(options).speed_m_s, 1247, 4);  // parameter table of mains
}

TEST_F(TwoSensors, ThatShareNothingFindNothing) {
  const Correlation found = Correlate(Of("a.wav", "noise.wav"));
  EXPECT_FALSE(found.delay.correlated);
  EXPECT_TRUE(nlohmann::json::parse(WriteCorrelationJson(found))["from_a_m"].is_null());
}

TEST_F(TwoSensors, SayWhatIsWrongWithARecord) {
  EXPECT_NE(Problem(Of("a.wav", "none.wav")).find("no such file"), std::string::npos);
  EXPECT_NE(Problem(Of("a.wav", "fast.wav")).find("16000"), std::string::npos);
  EXPECT_NE(Problem(Of("a.wav", "silent.wav")).find("silent"), std::string::npos);
  EXPECT_NE(Problem(Of("brief.wav", "b.wav")).find("record longer"), std::string::npos);
  CorrelateOptions options = Of("a.wav", "b.wav");
  options.distance_m = -5;
  EXPECT_NE(Problem(options).find("distance_m"), std::string::npos);
  options = Of("a.wav", "b.wav");
  options.speed_m_s.reset();
  EXPECT_NE(Problem(options).find("speed"), std::string::npos);
}

}  // namespace
}  // namespace piperun::scenarios
