#include "estimator/leak_locator.h"

#include <gtest/gtest.h>

#include "base/check.h"
#include "estimator/pipe_loss.h"
#include "tests/estimator/leak_sound.h"
#include "tests/estimator/walk.h"

namespace piperun::estimator {
namespace {

using namespace testing;  // the record generators

EstimatorStart PvcStart(double length_m = 24) {
  EstimatorStart start;
  start.map = MakeMap({{0, 0, 0}, {length_m, 0, 0}});
  return start;
}

std::vector<LeakEstimate> Locate(std::string_view kind, const SoundScene& scene, std::uint64_t seed,
                                 std::size_t block = 1600, std::vector<Settings::Value> settings = {}) {
  const auto locator = MakeLocator(kind, PvcStart(), std::move(settings));
  SoundRecord(scene, seed).Feed(*locator, block);
  return locator->leaks();
}

/// Detections within a metre of the leak, the errors of those, and reports elsewhere.
struct Tally {
  int found = 0;
  int false_alarms = 0;
  std::vector<double> errors_m;
  std::vector<double> normalised;
};

void Count(const std::vector<LeakEstimate>& leaks, double truth_m, Tally& tally) {
  bool found = false;
  for (const LeakEstimate& leak : leaks) {
    const double error = leak.chainage_m - truth_m;
    if (found || std::abs(error) > 1) {
      ++tally.false_alarms;
      continue;
    }
    found = true;
    tally.errors_m.push_back(std::abs(error));
    tally.normalised.push_back(error / leak.sigma_m);
  }
  tally.found += found;
}

Tally Campaign(std::string_view kind, SoundScene scene, double snr_dB, int runs) {
  Tally tally;
  for (int seed = 1; seed <= runs; ++seed) {
    const double place_m = 9 + 0.29 * seed;
    scene.leaks = {{place_m, snr_dB}};
    Count(Locate(kind, scene, static_cast<std::uint64_t>(seed)), place_m, tally);
  }
  std::printf("%-14s %+3.0f dB: found %d of %d, false alarms %d, |error| median %.3f m, worst %.3f m\n",
              std::string(kind).c_str(), snr_dB, tally.found, runs, tally.false_alarms,
              tally.errors_m.empty() ? NAN : Median(tally.errors_m),
              tally.errors_m.empty() ? NAN : *std::max_element(tally.errors_m.begin(), tally.errors_m.end()));
  return tally;
}

TEST(LeakLocator, BothFindAStrongLeakWithinCentimetres) {
  SoundScene scene;
  scene.leaks = {{13.4, 20}};
  for (const char* kind : {"matched_filter", "envelope_peak"}) {
    const auto leaks = Locate(kind, scene, 1);
    ASSERT_EQ(leaks.size(), 1u) << kind;
    EXPECT_NEAR(leaks[0].chainage_m, 13.4, 0.1) << kind;
    EXPECT_NEAR(leaks[0].p_W.x(), leaks[0].chainage_m, 1e-6) << kind;
    EXPECT_NEAR(Seconds(leaks[0].t_cpa), leaks[0].chainage_m / scene.speed_m_s, 1e-3) << kind;
    EXPECT_GT(leaks[0].confidence, 0.5) << kind;
    EXPECT_GT(leaks[0].sigma_m, 0) << kind;
  }
}

TEST(LeakLocator, MatchedFilterBeatsTheEnvelopeInDriftAndImpactsSlow) {
  // The envelope needs its 3 dB over a background that itself drifts by 2 dB; the prototype's smoothing found
  // nothing at +3 dB either, its matched filter on the ratio 0.98 with a median error of 0.06 m (at 4 dB/m).
  SoundScene scene;
  scene.drift_dB = 2;
  scene.joint_spacing_m = 5.7;
  scene.joint_dB = 12;
  const int runs = 20;
  const Tally matched_high = Campaign("matched_filter", scene, 20, runs);
  const Tally envelope_high = Campaign("envelope_peak", scene, 20, runs);
  EXPECT_EQ(matched_high.found, runs);
  EXPECT_EQ(envelope_high.found, runs);
  EXPECT_LT(Median(matched_high.errors_m), 0.03);
  EXPECT_LT(Median(matched_high.errors_m), Median(envelope_high.errors_m));
  const Tally matched_low = Campaign("matched_filter", scene, 3, runs);
  const Tally envelope_low = Campaign("envelope_peak", scene, 3, runs);
  EXPECT_GE(matched_low.found, 18);
  EXPECT_LE(matched_low.false_alarms, 1);
  EXPECT_LT(Median(matched_low.errors_m), 0.06);
  EXPECT_LT(envelope_low.found, matched_low.found / 2);
}

TEST(LeakLocator, MatchedFiltersSigmaCoversItsErrorsSlow) {
  SoundScene scene;
  const Tally tally = Campaign("matched_filter", scene, 10, 30);
  double squares = 0;
  for (const double z : tally.normalised) squares += z * z;
  const double n = static_cast<double>(tally.normalised.size());
  std::printf("mean squared error over sigma squared: %.2f\n", squares / n);
  ASSERT_GE(n, 28);
  // chi2(30) / 30 lies within 0.36 and 2.0 with probability 0.998; correlated residuals may widen sigma
  EXPECT_LT(squares / n, 2.0);
  EXPECT_GT(squares / n, 0.2);
}

TEST(LeakLocator, TwoLeaksFiveMetresApartAreTwo) {
  SoundScene scene;
  scene.leaks = {{9, 20}, {14, 17}};
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const auto leaks = Locate("matched_filter", scene, seed);
    ASSERT_EQ(leaks.size(), 2u) << seed;
    EXPECT_NEAR(leaks[0].chainage_m, 9, 0.12);
    EXPECT_NEAR(leaks[1].chainage_m, 14, 0.12);
    EXPECT_LT(leaks[0].t_cpa, leaks[1].t_cpa);
    const auto peaks = Locate("envelope_peak", scene, seed, 1600, {{"max_leaks", 4, ""}});
    EXPECT_EQ(peaks.size(), 2u) << seed;
  }
}

const WallMaterial kIron{"ductile_iron", 165e9, 0.02, 0.28, 7050, 1e-4};

/// Pipes in a row, each to an end, of DN150 plastic or iron.
EstimatorStart StartAlong(const std::vector<std::pair<double, WallMaterial>>& pipes) {
  std::vector<NodeSpec> nodes{{"N0", {0, 0, 0}}};
  std::vector<PipeSpec> specs;
  std::vector<RouteLeg> legs;
  for (const auto& [end_m, wall] : pipes) {
    nodes.push_back({"N" + std::to_string(nodes.size()), {end_m, 0, 0}});
    PipeSpec pipe;
    pipe.id = "P" + std::to_string(specs.size());
    pipe.from = nodes[nodes.size() - 2].id;
    pipe.to = nodes.back().id;
    pipe.diameter_m = wall.name == "ductile_iron" ? 0.158 : 0.1475;
    pipe.wall_thickness_m = wall.name == "ductile_iron" ? 0.006 : 0.0075;
    pipe.material = wall;
    legs.push_back({static_cast<int>(specs.size()), false});
    specs.push_back(pipe);
  }
  Network network(nodes, specs);
  Route route(network, legs);
  EstimatorStart start;
  start.map = RouteMap{std::move(network), std::move(route)};
  return start;
}

std::vector<LeakEstimate> LocateAlong(const EstimatorStart& start, const SoundScene& scene,
                                      std::uint64_t seed) {
  const auto locator = MakeLocator("matched_filter", start);
  SoundRecord(scene, seed).Feed(*locator, 1600);
  return locator->leaks();
}

TEST(LeakLocator, APumpsToneDoesNotMakeADriftingBackgroundLookLikeALeakSlow) {
  // the tone stands 15 dB over all noise of the reference band, which so no longer follows the drift
  SoundScene scene;
  scene.length_m = 700;
  scene.speed_m_s = 1;
  scene.attenuation_dB_m_kHz = 0.12;
  scene.drift_dB = 2;
  scene.tone_Pa = 0.6;
  const EstimatorStart iron = StartAlong({{700, kIron}});
  EXPECT_TRUE(LocateAlong(iron, scene, 1).empty());
  scene.leaks = {{350, 10}};
  const auto leaks = LocateAlong(iron, scene, 2);
  ASSERT_EQ(leaks.size(), 1u);
  EXPECT_NEAR(leaks[0].chainage_m, 350, 2);
  EXPECT_TRUE(leaks[0].interval.Holds(350));
}

TEST(LeakLocator, AWayFromIronIntoPlasticIsHeardWithTemplatesOfBothSlow) {
  // a roof 12 dB high is 50 m wide to each side in iron and 2 m in plastic
  SoundScene scene;
  scene.length_m = 500;
  scene.speed_m_s = 1;
  scene.attenuation_dB_m_kHz = 0.12;
  scene.second_from_m = 400;
  scene.second_attenuation_dB_m_kHz = 3.2;
  scene.leaks = {{180, 10}, {450, 10}};
  const auto leaks = LocateAlong(StartAlong({{400, kIron}, {500, PvcU()}}), scene, 3);
  ASSERT_EQ(leaks.size(), 2u);
  EXPECT_NEAR(leaks[0].chainage_m, 180, 2);
  EXPECT_NEAR(leaks[1].chainage_m, 450, 0.1);
  EXPECT_LT(leaks[1].sigma_m, 0.25 * leaks[0].sigma_m);
}

TEST(LeakLocator, TheCoarserLocatorsTooHearEachWallWithItsOwnWidthSlow) {
  // a cell of iron's is 25 m wide and more: a roof of 4 m would be lost in it
  SoundScene scene;
  scene.length_m = 500;
  scene.speed_m_s = 1;
  scene.attenuation_dB_m_kHz = 0.12;
  scene.second_from_m = 400;
  scene.second_attenuation_dB_m_kHz = 3.2;
  scene.leaks = {{450, 15}};
  for (const char* kind : {"cfar_ratio", "wavelet_kurtosis"}) {
    const auto locator = MakeLocator(kind, StartAlong({{400, kIron}, {500, PvcU()}}));
    SoundRecord(scene, 3).Feed(*locator, 1600);
    int in_plastic = 0;
    for (const LeakEstimate& leak : locator->leaks()) {
      if (leak.chainage_m < 400) continue;
      ++in_plastic;
      EXPECT_NEAR(leak.chainage_m, 450, 0.5) << kind;
      EXPECT_LT(leak.sigma_m, 1) << kind;
    }
    EXPECT_EQ(in_plastic, 1) << kind;
  }
}

TEST(LeakLocator, ALeakBesideATeeIsOneLeakAtItsPlace) {
  // behind the tee it is 3.52 dB weaker, in both bands alike
  for (const double leak_m : {11.0, 12.8}) {
    SoundScene scene;
    scene.tee_m = 12;
    scene.leaks = {{leak_m, 12}};
    const auto leaks = Locate("matched_filter", scene, 5);
    ASSERT_EQ(leaks.size(), 1u) << leak_m;
    EXPECT_NEAR(leaks[0].chainage_m, leak_m, 0.15);
  }
}

TEST(LeakLocator, QuietPipeGivesNoFalseAlarmSlow) {
  // 2 km at the promised 0.1 per km: more than two would have a probability of 0.1 %
  SoundScene scene;
  scene.length_m = 2000;
  scene.speed_m_s = 1;
  scene.drift_dB = 2;
  scene.joint_spacing_m = 6;
  EXPECT_LE(Locate("matched_filter", scene, 7).size(), 2u);
}

TEST(LeakLocator, BlockSizeChangesNoBit) {
  SoundScene scene;
  scene.leaks = {{13.4, 12}};
  for (const char* kind : {"matched_filter", "envelope_peak"}) {
    const auto one = Locate(kind, scene, 3, 1600);
    ASSERT_FALSE(one.empty());
    for (const std::size_t block : {std::size_t{1}, std::size_t{777}, std::size_t{16000}}) {
      const auto other = Locate(kind, scene, 3, block);
      ASSERT_EQ(other.size(), one.size());
      for (std::size_t i = 0; i < one.size(); ++i) {
        EXPECT_EQ(one[i].chainage_m, other[i].chainage_m) << kind << block;
        EXPECT_EQ(one[i].sigma_m, other[i].sigma_m) << kind << block;
        EXPECT_EQ(one[i].t_cpa, other[i].t_cpa) << kind << block;
        EXPECT_EQ(one[i].confidence, other[i].confidence) << kind << block;
      }
    }
  }
}

TEST(LeakLocator, WithoutAMapTheSlopeIsFoundFromTheSound) {
  SoundScene scene;
  scene.leaks = {{12, 15}};
  const auto locator = MakeLocator("matched_filter", EstimatorStart{});
  SoundRecord(scene, 4).Feed(*locator, 1600);
  ASSERT_EQ(locator->leaks().size(), 1u);
  EXPECT_NEAR(locator->leaks()[0].chainage_m, 12, 0.1);
}

TEST(LeakLocator, BandBeyondHalfTheRateIsRefused) {
  const auto locator = MakeLocator("matched_filter", PvcStart(), {{"band_high_Hz", 9000, ""}});
  const std::vector<std::int32_t> counts(16);
  EXPECT_THROW(locator->IngestAudio({RobotTime{}, 16000, 1, counts}), InputError);
  EXPECT_THROW(MakeLocator("matched_filter", PvcStart(), {{"band_low_Hz", 5000, ""}}), InputError);
}

TEST(LeakLocator, SilenceAndAMissingTrackGiveNothing) {
  const std::vector<std::int32_t> silence(16000);
  for (const char* kind : {"matched_filter", "envelope_peak"}) {
    const auto locator = MakeLocator(kind, PvcStart());
    for (int i = 1; i <= 10; ++i) locator->IngestAudio({RobotTime(FromSeconds(i)), 16000, 1, silence});
    locator->Finish();
    EXPECT_TRUE(locator->leaks().empty());
  }
}

TEST(PipeLoss, FollowsTheTableOfPlasticAndIron) {
  // computed with the same formula at 10 C for the acoustics table, with viscosity: 3.21 dB/m at 1 kHz in
  // DN150 PVC-U and 0.118 in DN150 ductile iron; viscosity's share is 0.005 dB/m
  Pipe pvc;
  pvc.diameter_m = 0.1475;
  pvc.wall_thickness_m = 0.0075;
  pvc.material = PvcU();
  EXPECT_NEAR(CalcAttenuation_dB_m(pvc, 1000), 3.21, 0.03);
  Pipe iron;
  iron.diameter_m = 0.158;
  iron.wall_thickness_m = 0.006;
  iron.material = {"ductile_iron", 165e9, 0.02, 0.28, 7050, 1e-4};
  EXPECT_NEAR(CalcAttenuation_dB_m(iron, 1000), 0.118, 0.008);
}

}  // namespace
}  // namespace piperun::estimator
