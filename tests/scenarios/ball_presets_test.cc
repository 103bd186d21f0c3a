#include "scenarios/ball_presets.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "scenarios/assemble.h"
#include "scenarios/reference.h"
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

Scenario WithBall(const std::string& ball, const std::vector<std::string>& more = {}) {
  std::vector<std::string> overrides{"ball=" + ball};
  overrides.insert(overrides.end(), more.begin(), more.end());
  return MakeSmallScenario(overrides);
}

TEST(BallPresets, APresetIsWhereTheFileBegins) {
  const Scenario plain = WithBall("{preset: foam_2.5in}");
  EXPECT_DOUBLE_EQ(plain.ball.radius_m, 0.0508);
  EXPECT_DOUBLE_EQ(plain.ball.rolling_resistance, 0.03);
  const Scenario changed =
      WithBall("{rolling_resistance: 0.01, preset: foam_2.5in, contact_stiffness_N_m: rigid}");
  EXPECT_DOUBLE_EQ(changed.ball.radius_m, 0.0508);
  EXPECT_DOUBLE_EQ(changed.ball.rolling_resistance, 0.01) << "what the file says counts, wherever it stands";
  EXPECT_FALSE(changed.ball.contact_stiffness_N_m);
}

TEST(BallPresets, NoPresetMeansTheDefaultsOfTheKeys) {
  const Scenario scenario = WithBall("{radius_mm: 20}");
  EXPECT_EQ(scenario.ball.preset, "none");
  EXPECT_EQ(scenario.ball.density_kg_m3, sim::BallParams{}.density_kg_m3);
}

TEST(BallPresets, TheEffectiveScenarioReadsBackToTheSameBytes) {
  for (const BallPreset& preset : BallPresets()) {
    const std::string ball = "{preset: " + std::string(preset.name) + ", friction: 0.3}";
    const std::string written = WriteScenario(WithBall(ball));
    const Scenario again = ParseScenario(written, "again.yaml");
    EXPECT_EQ(again.ball.preset, preset.name);
    EXPECT_EQ(again.ball.friction, 0.3);
    EXPECT_EQ(WriteScenario(again), written);
  }
}

TEST(BallPresets, AnUnknownNameIsCorrected) {
  const InputError e = ErrorOf([] { WithBall("{preset: foam_2.5}"); });
  EXPECT_EQ(e.key_path(), "ball.preset");
  EXPECT_NE(e.problem().find("did you mean 'foam_2.5in'?"), std::string::npos) << e.problem();
}

TEST(BallPresets, TheReferenceListsThem) {
  const std::string reference = WriteReference();
  for (const BallPreset& preset : BallPresets())
    EXPECT_NE(reference.find("- `" + std::string(preset.name) + "`: "), std::string::npos) << preset.name;
}

/// The pipes that foam balls are for.
struct FoamBall {
  const char* name;
  double outside_in, pipe_in;
};
constexpr FoamBall kFoamBalls[] = {
    {"foam_2.5in", 4, 6}, {"foam_2.5in_10in", 5, 10}, {"foam_2.5in_16in", 8, 16}};

TEST(BallPresets, FoamBallsWeighAndTurnLikeACoreInASoakedShell) {
  constexpr double kCore = 1400, kFoam = 1006, a = 1.25 * 0.0254;
  for (const FoamBall& foam : kFoamBalls) {
    const sim::BallParams& ball = FindBall(foam.name);
    const double r = 0.5 * foam.outside_in * 0.0254;
    EXPECT_NEAR(ball.radius_m, r, 1e-12);
    EXPECT_NEAR(ball.foam_thickness_m, r - a, 1e-12);
    const auto solid = [](double density, double radius) {
      return density * 4 / 3 * std::numbers::pi * radius * radius * radius;
    };
    const double mass = solid(kCore - kFoam, a) + solid(kFoam, r);
    const double inertia = 0.4 * (solid(kCore - kFoam, a) * a * a + solid(kFoam, r) * r * r);
    EXPECT_NEAR(ball.mass_kg() / mass, 1, 5e-4) << foam.name;  // written to four digits
    EXPECT_NEAR(ball.inertia_factor, inertia / (mass * r * r), 5e-4) << foam.name;
  }
}

TEST(BallPresets, FoamGivesWayLikeAnElasticFoundation) {
  // an impact at 0.3 m/s integrated with the force itself, pi E r_e x^2/h, in steps of a microsecond: the
  // linear spring takes up the same energy at the same greatest overlap
  for (const FoamBall& foam : kFoamBalls) {
    const sim::BallParams& ball = FindBall(foam.name);
    const double r = ball.radius_m, bore = 0.5 * foam.pipe_in * 0.0254, r_e = r / std::sqrt(1 - r / bore);
    const double mass = ball.mass_kg() + 0.62 * 1000 * ball.volume_m3();
    double x = 0, v = 0.3;
    while (v > 0) {
      v -= 1e-6 * std::numbers::pi * 1e5 * r_e * x * x / ball.foam_thickness_m / mass;
      x += 1e-6 * v;
    }
    EXPECT_NEAR(*ball.contact_stiffness_N_m / (mass * 0.3 * 0.3 / (x * x)), 1, 3e-3) << foam.name;
    const double critical = 2 * std::sqrt(*ball.contact_stiffness_N_m * mass);
    EXPECT_NEAR(ball.contact_damping_N_s_m / critical, 0.7, 5e-3) << foam.name;
    EXPECT_GT(*ball.contact_stiffness_N_m, 2000) << "the published band";
    EXPECT_LT(*ball.contact_stiffness_N_m, 10000);
  }
}

TEST(BallPresets, EveryPresetRunsThroughItsPipe) {
  for (const auto& [name, diameter_mm] : {std::pair{"prototype_60mm", 150.0},
                                          {"foam_2.5in", 152.4},
                                          {"foam_2.5in_10in", 254.0},
                                          {"foam_2.5in_16in", 406.4}}) {
    const double area = 0.25e-6 * std::numbers::pi * diameter_mm * diameter_mm;
    const Scenario scenario =
        WithBall(std::string("{preset: ") + name + "}",
                 {"network.pipes[0].diameter_mm=" + std::to_string(diameter_mm),
                  "flow.inlet_m3_s=" + std::to_string(0.7 * area), "estimators={}", "sensors={}"});
    const TemporaryFolder folder;
    const RunResult result = RunInto(scenario, folder / "run");
    EXPECT_EQ(result.status, "ok") << name;
    EXPECT_TRUE(result.warnings.empty()) << name << ": " << result.warnings.front();
  }
}

TEST(BallChecks, ValidationFindsWhatPhysicsCannotMean) {
  const auto refused = [](const std::string& ball, const std::vector<std::string>& more = {}) {
    return ErrorOf([&] { Assemble(WithBall(ball, more)); });
  };
  EXPECT_EQ(refused("{radius_mm: 80}").key_path(), "ball.radius_m");
  EXPECT_EQ(refused("{density_kg_m3: -5}").key_path(), "ball.density_kg_m3");
  EXPECT_EQ(refused("{density_kg_m3: 0}").key_path(), "ball.density_kg_m3");
  EXPECT_EQ(refused("{mass_kg: 0}").key_path(), "ball.mass_kg");
  EXPECT_EQ(refused("{foam_thickness_mm: 31}").key_path(), "ball.foam_thickness_m");
  EXPECT_EQ(refused("{center_of_mass_m: [0, 0.03, 0]}").key_path(), "ball.center_of_mass_m");
  const InputError foam =
      refused("{preset: foam_2.5in, added_mass_coefficient: 0.62, contact_stiffness_N_m: 2e4}",
              {"motion.rate_Hz=100"});
  EXPECT_EQ(foam.key_path(), "ball.contact_stiffness_N_m");
  EXPECT_FALSE(foam.where().empty());
  // w_c = sqrt(2e4/0.9457) = 145.4 rad/s
  EXPECT_NE(foam.problem().find("raise motion.rate_Hz to 146 at least"), std::string::npos) << foam.problem();
}

TEST(Run, SaysWhatItsStepsDidNotResolve) {
  const TemporaryFolder folder;
  const RunResult result = RunInto(MakeSmallScenario({"motion.rate_Hz=100", "ball={radius_mm: 20}",
                                                      "estimators={}", "sensors={}", "flow.inlet_m3_s=0.02"}),
                                   folder / "run");
  ASSERT_EQ(result.warnings.size(), 1u);
  EXPECT_EQ(result.warnings[0].find("spin: the ball turned by up to "), 0u) << result.warnings[0];
  EXPECT_NE(FileText(folder / "run/run.json").find("\"warnings\": [\n    \"spin: "), std::string::npos);
}

}  // namespace
}  // namespace piperun::scenarios
