#include "scenarios/channel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

#include "acoustics/audio_file.h"
#include "scenarios/assemble.h"
#include "tests/scenarios/small_scenario.h"

namespace piperun::scenarios {
namespace {

/// 3 m east, then 4 m north in a wider pipe that is laid southward.
Network MakeCorner() {
  const WallMaterial pvc{"pvc_u", 3.5e9, 0.05, 0.38, 1420, 1.5e-6};
  const std::vector<NodeSpec> nodes = {{"A", {0, 0, 0}}, {"B", {3, 0, 0}}, {"C", {3, 4, 0}}};
  return Network(nodes, {{.id = "P1",
                          .from = "A",
                          .to = "B",
                          .diameter_m = 0.1,
                          .wall_thickness_m = 0.005,
                          .vertices_m = {},
                          .material = pvc},
                         {.id = "P2",
                          .from = "C",
                          .to = "B",
                          .diameter_m = 0.2,
                          .wall_thickness_m = 0.01,
                          .vertices_m = {},
                          .material = pvc}});
}

sim::TruthState MakeTruth(int pipe, double s_m, bool reversed, const Vector3d& v_WB_W) {
  sim::TruthState truth;
  truth.pipe = pipe;
  truth.s_m = s_m;
  truth.reversed = reversed;
  truth.v_WB_W = v_WB_W;
  truth.water_speed_m_s = 0.5;
  return truth;
}

TEST(Listener, SlipIsTheWatersSpeedLessTheBallsAlongTheWayTaken) {
  const Network network = MakeCorner();
  EXPECT_NEAR(CalcListener(MakeTruth(0, 1, false, {0.3, 0.2, 0}), network).slip_speed_m_s, 0.2, 1e-15);
  // north through a pipe laid southward; then rolling back against the water
  EXPECT_NEAR(CalcListener(MakeTruth(1, 1, true, {0, 0.3, 0.1}), network).slip_speed_m_s, 0.2, 1e-15);
  EXPECT_NEAR(CalcListener(MakeTruth(1, 1, true, {0, -0.1, 0}), network).slip_speed_m_s, 0.6, 1e-15);
}

TEST(Listener, HasPlaceAndBoreOfTheBallsPipe) {
  const acoustics::ListenerState listener = CalcListener(MakeTruth(1, 2.5, true, {0, 0.3, 0}), MakeCorner());
  EXPECT_EQ(listener.pipe, 1);
  EXPECT_EQ(listener.s_m, 2.5);
  EXPECT_EQ(listener.bore_radius_m, 0.1);
  EXPECT_EQ(listener.water_speed_m_s, 0.5);
}

TEST(Listener, OutsideThePipesIsInNoPipe) {
  const acoustics::ListenerState listener = CalcListener(MakeTruth(-1, 0, false, {1, 0, 0}), MakeCorner());
  EXPECT_EQ(listener.pipe, -1);
  EXPECT_EQ(listener.slip_speed_m_s, 0);
}

/// Six metres in two pipes, the second laid with or against the way.
Scenario MakeTwoPipes(bool against) {
  std::string text = kSmallScenario;
  const auto replace = [&text](const std::string& what, const std::string& with) {
    text.replace(text.find(what), what.size(), with);
  };
  const std::string wall = ", diameter_mm: 150, wall_thickness_mm: 7.5, material: pvc_u}";
  replace("    - {id: B,", "    - {id: M, position_m: [2, 0, 0]}\n    - {id: B,");
  replace("{id: P1, from: A, to: B" + wall, "{id: P1, from: A, to: M" + wall + "\n    - {id: P2, " +
                                                (against ? "from: B, to: M" : "from: M, to: B") + wall);
  replace("pipe: P1, s_m: 3.1", against ? "pipe: P2, s_m: 2.9" : "pipe: P2, s_m: 1.1");
  replace("pipe: P1, s_m: 3,", "pipe: P1, s_m: 1,");
  return ParseScenario(text, "two_pipes.yaml", {});
}

TEST(AcousticScene, HoldsAllPipesOfTheNetworkAndItsLeaksOnThem) {
  const auto assembly = Assemble(MakeTwoPipes(true));
  const acoustics::AcousticScene& scene = assembly->scene;
  ASSERT_EQ(scene.network.pipes.size(), 2u);
  EXPECT_EQ(scene.network.pipes[0].to_node, *assembly->network()->FindNode("M"));
  EXPECT_EQ(scene.network.pipes[1].from_node, *assembly->network()->FindNode("B"));
  EXPECT_EQ(scene.network.pipes[1].to_node, *assembly->network()->FindNode("M"));
  EXPECT_NEAR(scene.network.pipes[1].length_m, 4, 1e-12);
  ASSERT_EQ(scene.leaks.size(), 1u);
  EXPECT_EQ(scene.leaks[0].id, "L1");
  EXPECT_EQ(scene.leaks[0].pipe, 1);
  EXPECT_EQ(scene.leaks[0].s_m, 2.9);
}

std::vector<std::int32_t> RecordTwoPipes(bool against) {
  const TemporaryFolder folder;
  RunInto(MakeTwoPipes(against), folder / "run");
  acoustics::AudioReader reader(folder / "run/mav0/hydrophone0/audio.wav");
  std::vector<std::int32_t> counts(100000);
  EXPECT_EQ(reader.Read(counts), counts.size());
  return counts;
}

TEST(AcousticScene, APipeLaidAgainstTheWaySoundsAsOneLaidWithIt) {
  const auto with = RecordTwoPipes(false), against = RecordTwoPipes(true);
  double power = 0, difference = 0;
  for (std::size_t n = 0; n < with.size(); ++n) {
    const double a = with[n], b = against[n];
    power += a * a;
    difference += (a - b) * (a - b);
  }
  // the same noise at the same place: only rounding, at most to another code, tells the two apart
  EXPECT_GT(power, 1e4 * static_cast<double>(with.size()));
  EXPECT_LT(difference, static_cast<double>(with.size()));
}

sim::ContactEvent MakeBlow(int begin_ms, double impulse_N_s = 0.002, double peak_force_N = 2) {
  sim::ContactEvent event;
  event.begin = TrueTime(std::chrono::milliseconds(begin_ms));
  event.impulse_W_N_s = {0, 0, impulse_N_s};
  event.peak_force_N = peak_force_N;
  return event;
}

TEST(ContactTime, IsTheHalfSinesForASoftBallAndTheGivenOneForARigidBall) {
  EXPECT_NEAR(CalcContactTime_s(MakeBlow(0), true, 0.001), std::numbers::pi / 2 * 1e-3, 1e-15);
  EXPECT_EQ(CalcContactTime_s(MakeBlow(0), false, 0.001), 0.001);
}

/// The first second of the small scenario's hydrophone.
std::vector<std::int32_t> ListenFor(const Scenario& scenario, const std::vector<sim::ContactEvent>& blows) {
  const auto assembly = Assemble(scenario);
  Channel* hydrophone = nullptr;
  for (const auto& channel : assembly->channels) {
    if (dynamic_cast<HydrophoneChannel*>(channel.get())) hydrophone = channel.get();
  }
  sim::TruthWindow window(assembly->motion->rate(), 2000);
  for (int i = 0; i < 1500; ++i) {
    window.Push(assembly->motion->state());
    assembly->motion->Step();
  }
  for (const sim::ContactEvent& blow : blows) hydrophone->Hear(blow);
  std::vector<std::int32_t> counts;
  for (int block = 0; block < 10; ++block) {
    const auto& audio = std::get<AudioBlock>(hydrophone->Take(window)->value);
    counts.insert(counts.end(), audio.counts.begin(), audio.counts.end());
  }
  return counts;
}

TEST(HydrophoneChannel, HearsABlowWhenTheRobotsClockShowsItsTime) {
  // 0.8 s of true time are 0.8008 s of a clock that runs 1000 ppm fast: sample 12812.8
  const Scenario scenario =
      MakeSmallScenario({"ball.clock_drift_ppm=1000", "ball.clock_offset_s=3", "leaks=[]"});
  const auto without = ListenFor(scenario, {}), with = ListenFor(scenario, {MakeBlow(800)});
  const auto first = std::mismatch(with.begin(), with.end(), without.begin()).first - with.begin();
  EXPECT_EQ(first, 12813);
  // 0.002 N s in 1 ms: a tenth of 1503 Pa, half a contact time later
  std::int64_t loudest = 0;
  for (std::size_t n = 0; n < with.size(); ++n) {
    if (with[n] - without[n] >
        with[static_cast<std::size_t>(loudest)] - without[static_cast<std::size_t>(loudest)])
      loudest = static_cast<std::int64_t>(n);
  }
  EXPECT_NEAR(static_cast<double>(loudest), 12812.8 + 8.5, 1);
  const acoustics::HydrophoneParams params;
  const auto n = static_cast<std::size_t>(loudest);
  EXPECT_NEAR((with[n] - without[n]) * params.scale_Pa(), 150.3, 4);  // the 10 Hz high-pass takes 3 %
}

TEST(HydrophoneChannel, WaitsUntilCollisionsAreTold) {
  const auto assembly = Assemble(MakeSmallScenario());
  for (const auto& channel : assembly->channels) {
    const bool hears = dynamic_cast<HydrophoneChannel*>(channel.get()) != nullptr;
    EXPECT_EQ(channel->contact_delay(), hears ? sim::kContactEventDelay : Duration(0));
  }
}

}  // namespace
}  // namespace piperun::scenarios
