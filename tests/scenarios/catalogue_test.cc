#include <gtest/gtest.h>

#include <set>

#include "base/check.h"
#include "base/number.h"
#include "scenarios/assemble.h"
#include "scenarios/embedded.h"
#include "scenarios/estimator_input.h"
#include "scenarios/load.h"
#include "scenarios/materials.h"
#include "scenarios/reference.h"

namespace piperun::scenarios {
namespace {

TEST(Catalogue, EveryScenarioLoadsAndAssembles) {
  EXPECT_GE(EmbeddedScenarios().size(), 8u);
  for (const EmbeddedFile& file : EmbeddedScenarios()) {
    SCOPED_TRACE(std::string(file.name));
    const Scenario scenario = LoadScenario(std::string(file.name));
    EXPECT_EQ(scenario.name, file.name);
    EXPECT_FALSE(scenario.description.empty());
    const auto assembly = Assemble(scenario);
    const EstimatorInput input = MakeEstimatorInput(scenario, *assembly);
    for (const ToldEstimator& told : input.estimators) EXPECT_NE(MakeEstimator(input, told), nullptr);
  }
}

TEST(Catalogue, WhatEstimatorsAreToldHoldsNoLeak) {
  const Scenario scenario = LoadScenario("quickstart");
  const auto assembly = Assemble(scenario);
  EstimatorInput input = MakeEstimatorInput(scenario, *assembly);
  std::string text = WriteYaml([&](ParamVisitor& v) { input.Visit(v); });
  // of locators: how many to report and what to assume, not what there is
  for (const std::string own_parameter : {"max_leaks", "leak_pressure_Pa"}) {
    for (std::size_t at; (at = text.find(own_parameter)) != std::string::npos;)
      text.erase(at, own_parameter.size());
  }
  EXPECT_EQ(text.find("leak"), std::string::npos);
  EXPECT_EQ(text.find("hole_diameter"), std::string::npos);
  for (const LeakEntry& leak : scenario.leaks) {
    EXPECT_EQ(text.find(FormatNumber(leak.s_m)), std::string::npos) << "the place of leak " << leak.id;
  }
}

TEST(Catalogue, WalksHaveThePrintedLengths) {
  const std::pair<const char*, double> walks[] = {
      {"akkaya_walk_1", 23.45}, {"akkaya_walk_2", 45.77}, {"akkaya_walk_3", 50}};
  for (const auto& [name, length_m] : walks) {
    const auto assembly = Assemble(LoadScenario(name));
    EXPECT_NEAR(assembly->plan->length_m(), length_m, 1e-9) << name;
  }
}

TEST(SensorOptions, EveryKindSaysWhatItRecords) {
  const std::set<std::string_view> known{"imu", "magnetometer", "pressure", "temperature", "marker", "audio"};
  for (const KindOption& option : SensorOptions()) EXPECT_TRUE(known.contains(option.records)) << option.name;
}

TEST(Catalogue, UnknownNameIsCorrected) {
  try {
    LoadScenario("quikstart");
    FAIL() << "must throw";
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("did you mean 'quickstart'?"), std::string::npos);
  }
}

TEST(Materials, AreReadFromTheLibrary) {
  const WallParams pvc = FindWall("pvc_u", {});
  EXPECT_NEAR(pvc.young_modulus_Pa, 3.5e9, 1e8);
  const WallParams given{1, 2, 3, 4, 5};
  EXPECT_EQ(FindWall("pvc_u", given).loss_factor, 2);
}

TEST(Reference, NamesEveryKind) {
  const std::string text = WriteReference();
  for (const char* kind :
       {"`ball_in_pipe`", "`scripted`", "`imu`", "`magnetometer`", "`pressure`", "`temperature`",
        "`hydrophone`", "`turbulent_jet`", "`quaternion_ekf`", "`mission.stuck_after_s`"}) {
    EXPECT_NE(text.find(kind), std::string::npos) << kind;
  }
}

}  // namespace
}  // namespace piperun::scenarios
