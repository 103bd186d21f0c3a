#include "scenarios/detect.h"

#include <gtest/gtest.h>
#include <sndfile.h>

#include <cmath>
#include <cstdio>
#include <fstream>

#include "acoustics/audio_file.h"
#include "base/check.h"
#include "scenarios/detectors/survey.h"
#include "scenarios/materials.h"

namespace piperun::scenarios {
namespace {

namespace fs = std::filesystem;

class Detect : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / (std::string("piperun_detect_") +
                                           ::testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  static detectors::Survey MakeSurvey() {
    const WallParams wall = FindWall("pvc_u", {});
    detectors::Survey survey;
    survey.wall = {
        "pvc_u",         wall.young_modulus_Pa, wall.loss_factor, wall.poisson_ratio, wall.density_kg_m3,
        wall.roughness_m};
    survey.bore_m = 0.1475;
    survey.length_m = 60;
    survey.leaks = {{23.4, 10, 0}};
    return survey;
  }
  /// The survey as a 24-bit file and its true track.
  void WriteSurvey(const detectors::Survey& survey) const {
    acoustics::AudioWriter writer(folder_ / "audio.wav", {});
    std::int64_t samples = 0;
    detectors::RenderSurvey(survey, 1, 0, [&](const AudioBlock& block) {
      writer.Write(block.counts);
      samples += static_cast<std::int64_t>(block.counts.size());
    });
    writer.Close();
    std::ofstream track(folder_ / "track.csv");
    track << "time_s,chainage_m\n";
    for (int i = 0; i * 0.1 < static_cast<double>(samples) / 16000 + 0.2; ++i)
      track << i * 0.1 << ',' << detectors::CalcSurveyChainage_m(i * 0.1) << '\n';
  }
  /// A file of `channels` equal channels of one second, sample i being `value(i)`.
  template <class F>
  fs::path WriteFloat(int channels, F value) const {
    const fs::path path = folder_ / "float.wav";
    SF_INFO info{};
    info.samplerate = 16000;
    info.channels = channels;
    info.format = SF_FORMAT_WAV | SF_FORMAT_FLOAT;
    SNDFILE* file = sf_open(path.c_str(), SFM_WRITE, &info);
    std::vector<float> samples;
    for (int i = 0; i < 16000; ++i)
      samples.insert(samples.end(), static_cast<std::size_t>(channels), value(i));
    sf_writef_float(file, samples.data(), 16000);
    sf_close(file);
    return path;
  }
  DetectPipe Pipe() const {
    std::ofstream(folder_ / "pipe.yaml") << "material: pvc_u\ndiameter_mm: 147.5\nwall_thickness_mm: 7.5\n";
    return LoadDetectPipe(folder_ / "pipe.yaml");
  }
  static std::string Refusal(const DetectOptions& options) {
    try {
      scenarios::Detect(options);
    } catch (const InputError& e) {
      return e.what();
    }
    return "";
  }

  fs::path folder_;
};

TEST_F(Detect, FindsTheLeakOfARenderedPassageOnItsTrack) {
  WriteSurvey(MakeSurvey());
  const Detections found =
      scenarios::Detect({folder_ / "audio.wav", Pipe(), folder_ / "track.csv", "matched_filter"});
  ASSERT_EQ(found.leaks.size(), 1u);
  // 10 dB on a slope of some 4 dB/m: the error is centimetres; 0.35 m is promised at 3 dB
  EXPECT_NEAR(found.leaks[0].chainage_m, 23.4, 0.2);
  EXPECT_NEAR(detectors::CalcSurveyChainage_m(Seconds(found.leaks[0].t_cpa)), found.leaks[0].chainage_m,
              0.02);
  EXPECT_TRUE(found.placed);
  EXPECT_NE(DrawDetectionsSvg(found).find("polyline"), std::string::npos);
  EXPECT_NE(WriteDetectionsJson(found).find("\"piperun.detect/1\""), std::string::npos);
}

TEST_F(Detect, AConstantSpeedWidensTheIntervalByWhatIsNotKnownOfIt) {
  WriteSurvey(MakeSurvey());
  DetectOptions options{folder_ / "audio.wav", Pipe(), {}, "matched_filter"};
  const Detections exact = scenarios::Detect(options);
  options.speed_sd_m_s = 0.02;
  const Detections known = scenarios::Detect(options);
  ASSERT_EQ(exact.leaks.size(), 1u);
  ASSERT_EQ(known.leaks.size(), 1u);
  // both errors are independent: variances add, the way's is (s_v t)^2 where the leak was passed
  const double way_m = 0.02 * Seconds(known.leaks[0].t_cpa);
  EXPECT_NEAR(known.leaks[0].sigma_m, std::hypot(exact.leaks[0].sigma_m, way_m), 0.02 * way_m);
  EXPECT_NEAR(0.5 * (known.leaks[0].interval.high_m - known.leaks[0].interval.low_m), 1.96 * way_m,
              0.05 * way_m);
  EXPECT_NE(exact.interval_holds.find("taken as exact"), std::string::npos);
  EXPECT_NE(known.interval_holds.find("known to 0.02 m/s"), std::string::npos);
  options.track = folder_ / "track.csv";
  EXPECT_NE(Refusal(options).find("third column"), std::string::npos);
}

TEST_F(Detect, ATracksOwnUncertaintyIsInTheInterval) {
  WriteSurvey(MakeSurvey());
  std::ifstream plain(folder_ / "track.csv");
  std::ofstream uncertain(folder_ / "uncertain.csv");
  std::string line;
  std::getline(plain, line);
  uncertain << line << ",chainage_sd_m\n";
  while (std::getline(plain, line)) uncertain << line << ",0.7\n";
  uncertain.close();
  const Detections found =
      scenarios::Detect({folder_ / "audio.wav", Pipe(), folder_ / "uncertain.csv", "matched_filter"});
  ASSERT_EQ(found.leaks.size(), 1u);
  EXPECT_NEAR(found.leaks[0].sigma_m, 0.7, 0.05);
  std::ofstream(folder_ / "bad.csv") << "time_s,chainage_m,chainage_sd_m\n0,0,0\n1,1\n";
  EXPECT_NE(Refusal({folder_ / "audio.wav", Pipe(), folder_ / "bad.csv", "matched_filter"}).find("'1,1'"),
            std::string::npos);
}

TEST_F(Detect, AFlacFileSaysWhatTheWavSays) {
  WriteSurvey(MakeSurvey());
  SF_INFO info{};
  SNDFILE* wav = sf_open((folder_ / "audio.wav").c_str(), SFM_READ, &info);
  std::vector<int> samples(static_cast<std::size_t>(info.frames));
  sf_readf_int(wav, samples.data(), info.frames);
  sf_close(wav);
  info.format = SF_FORMAT_FLAC | SF_FORMAT_PCM_24;
  SNDFILE* flac = sf_open((folder_ / "audio.flac").c_str(), SFM_WRITE, &info);
  sf_writef_int(flac, samples.data(), static_cast<sf_count_t>(samples.size()));
  sf_close(flac);
  const auto found = [&](const char* name) {
    return scenarios::Detect({folder_ / name, Pipe(), folder_ / "track.csv", "matched_filter"});
  };
  const Detections of_wav = found("audio.wav"), of_flac = found("audio.flac");
  ASSERT_EQ(of_flac.leaks.size(), 1u);
  EXPECT_EQ(of_flac.leaks[0].chainage_m, of_wav.leaks[0].chainage_m);
  EXPECT_EQ(of_flac.leaks[0].interval.low_m, of_wav.leaks[0].interval.low_m);
}

TEST_F(Detect, ALeakBesideAMappedValveIsFlaggedAndADigPointLiesOnEarth) {
  WriteSurvey(MakeSurvey());
  std::ofstream(folder_ / "pipe.yaml")
      << "material: pvc_u\ndiameter_mm: 147.5\nwall_thickness_mm: 7.5\n"
         "fittings: [{id: V1, kind: valve, chainage_m: 23.9}]\n"
         "line_m: [[0, 0, 0], [0, 40, 0], [15, 53, 0]]\norigin: {latitude_deg: 50, longitude_deg: 8}\n";
  const DetectPipe pipe = LoadDetectPipe(folder_ / "pipe.yaml");
  const Detections found =
      scenarios::Detect({folder_ / "audio.wav", pipe, folder_ / "track.csv", "matched_filter"});
  ASSERT_EQ(found.leaks.size(), 1u);
  EXPECT_EQ(found.leaks[0].at, "valve V1");
  EXPECT_LT(found.leaks[0].confidence, 0.2);
  EXPECT_NE(WriteDetectionsJson(found).find("\"at\": \"valve V1\""), std::string::npos);
  EXPECT_NE(WriteDetectionsCsv(found).find(",valve V1\n"), std::string::npos);
  // the pipe runs north from 50 N, where a degree is 111229 m long (WGS 84: 111132.95 - 559.85 cos 2 phi
  // + 1.175 cos 4 phi)
  const std::string geojson = WriteDetectionsGeoJson(found);
  const std::size_t at = geojson.find("\"coordinates\": [") + 16;
  double longitude_deg = 0, latitude_deg = 0;
  ASSERT_EQ(std::sscanf(geojson.c_str() + at, " %lf , %lf", &longitude_deg, &latitude_deg), 2) << geojson;
  EXPECT_NEAR(longitude_deg, 8, 1e-8);
  EXPECT_NEAR((latitude_deg - 50) * 111229, found.leaks[0].chainage_m, 0.002);
  const Detections nowhere =
      scenarios::Detect({folder_ / "audio.wav", Pipe(), folder_ / "track.csv", "matched_filter"});
  EXPECT_THROW(WriteDetectionsGeoJson(nowhere), InputError);
}

TEST_F(Detect, WithoutAWaySaysTimesOnly) {
  WriteSurvey(MakeSurvey());
  const Detections found = scenarios::Detect({folder_ / "audio.wav", std::nullopt, {}, "matched_filter"});
  ASSERT_EQ(found.leaks.size(), 1u);
  EXPECT_FALSE(found.placed);
  EXPECT_NEAR(detectors::CalcSurveyChainage_m(Seconds(found.leaks[0].t_cpa)), 23.4, 0.4);
  EXPECT_NE(WriteDetectionsJson(found).find("\"chainage_m\": null"), std::string::npos);
}

TEST_F(Detect, RefusesWhatIsNoRecord) {
  EXPECT_NE(Refusal({folder_ / "none.wav", Pipe(), {}, "matched_filter"}).find("no such file"),
            std::string::npos);
  std::ofstream(folder_ / "text.wav") << "not audio at all, only text";
  EXPECT_NE(Refusal({folder_ / "text.wav", Pipe(), {}, "matched_filter"}).find("not a sound file"),
            std::string::npos);
  const auto refusal = [&](int channels, auto value) {
    return Refusal({WriteFloat(channels, value), Pipe(), {}, "matched_filter"});
  };
  EXPECT_NE(refusal(1, [](int) { return 0.F; }).find("silent"), std::string::npos);
  EXPECT_NE(refusal(2, [](int i) { return 0.1F * static_cast<float>(i % 2); }).find("channels"),
            std::string::npos);
  EXPECT_NE(refusal(1, [](int i) { return i == 77 ? NAN : 0.1F; }).find("sample 77"), std::string::npos);
  EXPECT_NE(refusal(1, [](int i) { return i % 10 == 0 ? 1.F : 0.1F; }).find("clipped"), std::string::npos);
}

TEST_F(Detect, RefusesABandBeyondTheRateAndATrackThatDoesNotCover) {
  SF_INFO info{};
  info.samplerate = 6000;
  info.channels = 1;
  info.format = SF_FORMAT_WAV | SF_FORMAT_PCM_16;
  const fs::path slow = folder_ / "slow.wav";
  SNDFILE* file = sf_open(slow.c_str(), SFM_WRITE, &info);
  const std::vector<short> samples(6000, 100);
  sf_writef_short(file, samples.data(), 6000);
  sf_close(file);
  EXPECT_NE(Refusal({slow, Pipe(), {}, "matched_filter"}).find("6000"), std::string::npos);
  std::ofstream(folder_ / "short.csv") << "time_s,chainage_m\n0,0\n0.5,0.2\n";
  const fs::path audio = WriteFloat(1, [](int i) { return 0.1F * static_cast<float>(i % 3); });
  EXPECT_NE(Refusal({audio, Pipe(), folder_ / "short.csv", "matched_filter"}).find("covers"),
            std::string::npos);
  EXPECT_NE(Refusal({audio, Pipe(), {}, "matched_filtre"}).find("did you mean 'matched_filter'"),
            std::string::npos);
}

}  // namespace
}  // namespace piperun::scenarios
