#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "acoustics/audio_file.h"
#include "acoustics/sound_file.h"
#include "scenarios/passage_log.h"
#include "tests/scenarios/small_scenario.h"

namespace piperun::scenarios {
namespace {

namespace fs = std::filesystem;

/// The small scenario with its stems kept.
class StemsRun : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TemporaryFolder();
    RunInto(MakeSmallScenario(), *folder_ / "plain");
    const Scenario kept = MakeSmallScenario({"sensors.hydrophone0.stems=true"});
    leaks_ = RunInto(kept, *folder_ / "kept").leaks;
  }
  static void TearDownTestSuite() {
    delete folder_;
    leaks_.clear();
  }
  static std::vector<double> ReadStem(const std::string& name) {
    acoustics::SoundFile file(*folder_ / ("kept/truth/stems/hydrophone0/" + name + ".wav"));
    std::vector<double> samples_Pa(static_cast<std::size_t>(file.frames()));
    EXPECT_EQ(file.Read(samples_Pa), samples_Pa.size());
    return samples_Pa;
  }
  static std::vector<std::string> StemNames() {
    return {"source_L1", "background_distant", "background_flow", "background_self", "knocks", "tones"};
  }

  static TemporaryFolder* folder_;
  static std::vector<TrueLeak> leaks_;
};
TemporaryFolder* StemsRun::folder_ = nullptr;
std::vector<TrueLeak> StemsRun::leaks_;

TEST_F(StemsRun, ChangesNothingButThatTheStemsAreThere) {
  for (const char* file :
       {"mav0/hydrophone0/audio.wav", "truth/leaks.csv", "estimates/ekf/leaks.csv", "estimator_input.yaml"}) {
    EXPECT_EQ(FileText(*folder_ / "plain" / file), FileText(*folder_ / "kept" / file)) << file;
  }
  EXPECT_FALSE(fs::exists(*folder_ / "plain/truth/stems"));
}

TEST_F(StemsRun, KeepsOneFilePerSourceThatAddUpToTheRecord) {
  acoustics::AudioReader reader(*folder_ / "kept/mav0/hydrophone0/audio.wav");
  std::vector<std::int32_t> counts(static_cast<std::size_t>(reader.frames()));
  reader.Read(counts);
  std::vector<double> sum_Pa(counts.size());
  for (const std::string& name : StemNames()) {
    const std::vector<double> stem_Pa = ReadStem(name);
    ASSERT_EQ(stem_Pa.size(), counts.size()) << name;
    for (std::size_t n = 0; n < sum_Pa.size(); ++n) sum_Pa[n] += stem_Pa[n];
  }
  const acoustics::HydrophoneParams params;
  double worst = 0;
  for (std::size_t n = 0; n < counts.size(); ++n) {
    if (std::abs(counts[n]) >= params.largest_code()) continue;
    worst = std::max(worst, std::abs(sum_Pa[n] / params.scale_Pa() - counts[n]));
  }
  EXPECT_LT(worst, 0.5 + params.full_scale_Pa * 0x1p-21 / params.scale_Pa());  // rounding to float, twice
}

/// labels.csv without its header, in fields.
std::vector<std::vector<std::string>> ReadLabels(const fs::path& path) {
  std::ifstream file(path);
  std::string line, field;
  std::getline(file, line);
  EXPECT_EQ(line, "id,begin_ns,t_cpa_ns,end_ns,snr_dB,snr_stems_dB");
  std::vector<std::vector<std::string>> rows;
  while (std::getline(file, line)) {
    std::istringstream fields(line);
    std::vector<std::string>& row = rows.emplace_back();
    while (std::getline(fields, field, ',')) row.push_back(field);
  }
  return rows;
}

TEST_F(StemsRun, LabelsThePassageAndTheSpanInWhichTheLeakIsHeard) {
  const auto rows = ReadLabels(*folder_ / "kept/truth/labels.csv");
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_EQ(rows[0][0], "L1");
  const std::int64_t begin = std::stoll(rows[0][1]), passed = std::stoll(rows[0][2]),
                     end = std::stoll(rows[0][3]);
  EXPECT_EQ(passed, *leaks_[0].t_cpa_ns);
  EXPECT_LE(begin, passed);
  EXPECT_GE(end, passed);
  EXPECT_EQ(std::stod(rows[0][4]), *leaks_[0].snr_dB);
}

TEST_F(StemsRun, MeasuresTheSignalToNoiseRatioInTheStems) {
  const auto plain = ReadLabels(*folder_ / "plain/truth/labels.csv");
  EXPECT_EQ(plain[0].size(), 5u);  // nothing behind the last comma
  const double measured_dB = std::stod(ReadLabels(*folder_ / "kept/truth/labels.csv")[0][5]);
  // the model's ratio, its power averaged over the half second of the passage, at the ball's 0.46 m/s
  const auto assembly = Assemble(MakeSmallScenario());
  const acoustics::HydrophoneParams params;
  double mean = 0;
  constexpr int kPlaces = 41;
  for (int i = 0; i < kPlaces; ++i) {
    acoustics::ListenerState listener;
    listener.pipe = 0;
    listener.s_m = assembly->pipeline->leaks[0].s_m + 0.46 * 0.5 * ((i + 0.5) / kPlaces - 0.5);
    listener.bore_radius_m = 0.075;
    mean += std::pow(10, 0.1 * CalcLeakSnr_dB(assembly->scene, 0, params, listener, 1000, 4000)) / kPlaces;
  }
  EXPECT_NEAR(measured_dB, 10 * std::log10(mean), 4 * 0.15);
}

/// A ball in the only pipe of the small scenario, rolling on at 0.5 m/s.
sim::TruthState RollingAt(double s_m) {
  sim::TruthState state;
  state.time = TrueTime(FromSeconds(s_m / 0.5));
  state.pipe = 0;
  state.s_m = s_m;
  state.v_WB_W = {0.5, 0, 0};
  state.water_speed_m_s = 0.55;
  return state;
}

TEST(PassageLog, HearsTheLeakWhereItStandsAboveAllTheRest) {
  Scenario scenario = MakeSmallScenario();
  const auto assembly = Assemble(scenario);
  const double leak_s_m = assembly->pipeline->leaks[0].s_m,
               step_m = 0.5 * assembly->motion->rate().Period_s();
  PassageLog log(*assembly);
  for (int k = 0; k * step_m < 6; ++k) log.Watch(RollingAt(k * step_m));
  const auto passage = log.Find(0);
  ASSERT_TRUE(passage && passage->passed && passage->snr_dB);
  EXPECT_NEAR(Seconds(passage->passed->time_since_epoch()), leak_s_m / 0.5, 1e-6);
  ASSERT_TRUE(passage->heard);
  acoustics::HydrophoneParams params;
  const auto snr_dB = [&](double s_m) {
    return acoustics::CalcLeakSnr_dB(assembly->scene, 0, params,
                                     CalcListener(RollingAt(s_m), *assembly->network()), 1000, 4000);
  };
  EXPECT_NEAR(*passage->snr_dB, snr_dB(leak_s_m), 0.05);
  const double begin_s = Seconds(passage->heard->begin.time_since_epoch()),
               end_s = Seconds(passage->heard->end.time_since_epoch());
  EXPECT_GE(snr_dB(0.5 * begin_s), -0.05);  // audible at both ends of the span
  EXPECT_GE(snr_dB(0.5 * end_s), -0.05);
  EXPECT_TRUE(begin_s <= 0.1 || snr_dB(0.5 * (begin_s - 0.1)) < 0.05);  // and not a look beyond
  EXPECT_TRUE(end_s >= 11.8 || snr_dB(0.5 * (end_s + 0.1)) < 0.05);
}

TEST(PassageLog, OfALeakThatIsDrownedHasNoSpan) {
  Scenario scenario = MakeSmallScenario();
  scenario.ambient.distant_level_dB_re_1uPa2_Hz = 160;
  const auto assembly = Assemble(scenario);
  PassageLog log(*assembly);
  for (int k = 0; k < 6000; ++k) log.Watch(RollingAt(0.001 * k));
  const auto passage = log.Find(0);
  ASSERT_TRUE(passage && passage->passed);
  EXPECT_FALSE(passage->heard);
  EXPECT_LT(*passage->snr_dB, 0);
}

TEST(PassageLog, OfABallThatTurnsBackHasNoPassage) {
  const auto assembly = Assemble(MakeSmallScenario());
  PassageLog log(*assembly);
  for (int k = 0; k < 2000; ++k) log.Watch(RollingAt(0.001 * k));
  const auto passage = log.Find(0);
  ASSERT_TRUE(passage);
  EXPECT_FALSE(passage->passed);
}

}  // namespace
}  // namespace piperun::scenarios
