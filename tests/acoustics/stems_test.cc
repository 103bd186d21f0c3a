#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "tests/acoustics/scenes.h"

namespace piperun::acoustics {
namespace {

constexpr double kSeconds = 20;

/// Two leaks in PVC 4 m apart, distant noise, eddies, a tone and a knock, 2 m beside the first leak.
struct Recording {
  std::vector<std::int32_t> counts;
  std::vector<std::string> names;
  std::vector<std::vector<float>> stems_Pa;
};

AcousticScene MakeScene() {
  AcousticScene scene = MakeQuietScene(MakePvcWave());
  scene.ambient = {};
  AddLeak(scene, 100, MakeJet(1e-5, 1e-3));
  AddLeak(scene, 104, MakeJet(3e-5, 2e-3));
  ToneSource pump;
  pump.pipe = 0;
  pump.s_m = 90;
  pump.tones = {{345, 1e-6, 0}};
  scene.tones.push_back(pump);
  return scene;
}

HydrophoneParams MakeParams(bool stems) {
  HydrophoneParams params;
  params.stems = stems;
  return params;
}

Recording Record(bool stems, std::size_t block) {
  Hydrophone hydrophone(MakeParams(stems), MakeScene(), RandomStream(3, "hydrophone0", 0));
  hydrophone.Add({TrueTime(std::chrono::seconds(1)), 0.01, 0.01});
  Recording recording;
  recording.names = hydrophone.StemNames();
  recording.stems_Pa.resize(recording.names.size());
  const auto total = static_cast<std::size_t>(kSeconds * 16000);
  while (recording.counts.size() < total) {
    std::vector<std::int32_t> counts(std::min(block, total - recording.counts.size()));
    hydrophone.Render(StillAt(98), counts);
    recording.counts.insert(recording.counts.end(), counts.begin(), counts.end());
    for (std::size_t i = 0; i < recording.stems_Pa.size(); ++i) {
      const auto part = hydrophone.stem_Pa(i);
      recording.stems_Pa[i].insert(recording.stems_Pa[i].end(), part.begin(), part.end());
    }
  }
  return recording;
}

double CalcPower(const std::vector<float>& x) {
  double sum = 0;
  for (const float value : x) sum += static_cast<double>(value) * static_cast<double>(value);
  return sum / static_cast<double>(x.size());
}

double CalcCorrelation(const std::vector<float>& a, const std::vector<float>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += static_cast<double>(a[i]) * static_cast<double>(b[i]);
  return sum / static_cast<double>(a.size()) / std::sqrt(CalcPower(a) * CalcPower(b));
}

TEST(Stems, AreTheSourcesTheBackgroundsAndTheWaveforms) {
  EXPECT_EQ(Record(true, 1600).names,
            (std::vector<std::string>{"source_L1", "source_L2", "background_distant", "background_flow",
                                      "background_self", "knocks", "tones"}));
  EXPECT_TRUE(Record(false, 1600).names.empty());
}

TEST(Stems, ChangeNothingInTheRecordAndAddUpToIt) {
  const Recording with = Record(true, 1600), without = Record(false, 1600);
  ASSERT_EQ(with.counts, without.counts);
  const double scale_Pa = MakeParams(true).scale_Pa();
  double worst = 0;
  for (std::size_t n = 0; n < with.counts.size(); ++n) {
    double sum_Pa = 0;
    for (const auto& stem : with.stems_Pa) sum_Pa += static_cast<double>(stem[n]);
    worst = std::max(worst, std::abs(sum_Pa / scale_Pa - with.counts[n]));
  }
  // half a count of the converter (120 uPa) and single precision's rounding of up to 60 Pa in a knock
  EXPECT_LT(worst, 0.5 + 60 * 0x1p-21 / scale_Pa);
}

TEST(Stems, DoNotDependOnTheBlocks) {
  const Recording a = Record(true, 1600), b = Record(true, 777);
  EXPECT_EQ(a.counts, b.counts);
  EXPECT_EQ(a.stems_Pa, b.stems_Pa);
}

TEST(Stems, HaveTheLevelOfTheirSource) {
  const Recording recording = Record(true, 1600);
  Hydrophone hydrophone(MakeParams(true), MakeScene(), RandomStream(3, "hydrophone0", 0));
  std::vector<double> band_Pa2(3);
  hydrophone.CalcBandPower(StillAt(98)(TrueTime{}), 8, 8000, band_Pa2);
  for (std::size_t leak = 0; leak < 2; ++leak) {
    // a jet's power lies in some 2 kHz: 4 sigma of 1 / sqrt(B T)
    EXPECT_NEAR(CalcPower(recording.stems_Pa[leak]) / band_Pa2[leak], 1, 4 / std::sqrt(2000 * kSeconds));
  }
}

TEST(Stems, OfDifferentSourcesShareNothing) {
  const Recording recording = Record(true, 1600);
  const auto& stems = recording.stems_Pa;
  EXPECT_NEAR(CalcCorrelation(stems[0], stems[1]), 0, 4 / std::sqrt(2 * 2000 * kSeconds));
  EXPECT_NEAR(CalcCorrelation(stems[0], stems[4]), 0, 4 / std::sqrt(2 * 2000 * kSeconds));
  EXPECT_NEAR(CalcCorrelation(stems[2], stems[0]), 0, 4 / std::sqrt(2 * 50 * kSeconds));
}

TEST(BandPower, IsWhatTheFormulasSay) {
  const AcousticScene scene = MakeScene();
  const HydrophoneParams params = MakeParams(false);
  Hydrophone hydrophone(params, scene, RandomStream(3, "hydrophone0", 0));
  for (const double s_m : {97.0, 99.9, 103.0}) {
    const ListenerState listener = StillAt(s_m)(TrueTime{});
    std::vector<double> band_Pa2(3);
    hydrophone.CalcBandPower(listener, 1000, 4000, band_Pa2);
    for (std::size_t leak = 0; leak < 2; ++leak) {
      EXPECT_NEAR(10 * std::log10(band_Pa2[leak] / band_Pa2.back()),
                  CalcLeakSnr_dB(scene, leak, params, listener, 1000, 4000), 0.02);
    }
  }
}

TEST(BandPower, RefusesWhatIsNoBand) {
  Hydrophone hydrophone({}, MakeScene(), RandomStream(3, "hydrophone0", 0));
  std::vector<double> band_Pa2(3);
  EXPECT_THROW(hydrophone.CalcBandPower({}, 0, 4000, band_Pa2), InputError);
  EXPECT_THROW(hydrophone.CalcBandPower({}, 4000, 1000, band_Pa2), InputError);
  EXPECT_THROW(hydrophone.CalcBandPower({}, 1000, 8001, band_Pa2), InputError);
}

}  // namespace
}  // namespace piperun::acoustics
