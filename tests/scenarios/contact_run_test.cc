#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "acoustics/audio_file.h"
#include "tests/scenarios/small_scenario.h"

namespace piperun::scenarios {
namespace {

namespace fs = std::filesystem;

/// The small scenario with two joints.
Scenario MakeJointed(const std::vector<std::string>& overrides = {}) {
  return ParseScenario(std::string(kSmallScenario) +
                           "wall_features:\n"
                           "  - {id: J, pipe: P1, kind: joint, spacing_m: 2, gap_mm: 6, offset_mm: 1}\n",
                       "jointed.yaml", overrides);
}

std::vector<std::vector<std::string>> ReadRows(const fs::path& file) {
  std::vector<std::vector<std::string>> rows;
  std::istringstream lines(FileText(file));
  for (std::string line; std::getline(lines, line);) {
    rows.emplace_back();
    std::istringstream fields(line);
    for (std::string field; std::getline(fields, field, ',');) rows.back().push_back(field);
  }
  rows.erase(rows.begin());
  return rows;
}

std::vector<std::int32_t> ReadAudio(const fs::path& run) {
  acoustics::AudioReader reader(run / "mav0/hydrophone0/audio.wav");
  std::vector<std::int32_t> counts(1 << 20);
  counts.resize(reader.Read(counts));
  return counts;
}

TEST(ContactRun, ListsTheJointsThatTheBallMeets) {
  const TemporaryFolder folder;
  const RunResult result = RunInto(MakeJointed(), folder / "run");
  const auto rows = ReadRows(folder / "run/truth/contacts.csv");
  ASSERT_GE(rows.size(), 2U);
  EXPECT_EQ(result.contacts->count, static_cast<std::int64_t>(rows.size()));
  for (const char* joint : {"J[1]", "J[2]"}) {
    const auto hit =
        std::find_if(rows.begin(), rows.end(), [&](const auto& row) { return row.back() == joint; });
    ASSERT_NE(hit, rows.end()) << joint;
    // the ball touches the joint's lip within its radius of the gap
    EXPECT_NEAR(std::stod((*hit)[3]), joint[2] == '1' ? 2 : 4, 0.03);
  }
  EXPECT_TRUE(std::is_sorted(rows.begin(), rows.end(), [](const auto& a, const auto& b) {
    return std::stoll(a[0]) < std::stoll(b[0]);
  }));
  const auto json = nlohmann::json::parse(result.json);
  EXPECT_EQ(json["truth"]["contacts"]["count"], rows.size());
  EXPECT_TRUE(json["hash"].contains("truth/contacts.csv"));
}

TEST(ContactRun, IsHeardFromItsBeginningOnAndNotBefore) {
  const TemporaryFolder folder;
  RunInto(MakeJointed(), folder / "loud");
  RunInto(MakeJointed({"ambient.impacts.on=false"}), folder / "mute");
  const auto loud = ReadAudio(folder / "loud"), mute = ReadAudio(folder / "mute");
  ASSERT_EQ(loud.size(), mute.size());
  const auto first = std::mismatch(loud.begin(), loud.end(), mute.begin()).first - loud.begin();
  const double begin_s = std::stod(ReadRows(folder / "loud/truth/contacts.csv")[0][0]) * 1e-9;
  EXPECT_NEAR(static_cast<double>(first), begin_s * 16000, 1);
}

TEST(ContactRun, ReplayGivesTheSameEstimatesAndTheSameRunGivesTheSameBytes) {
  const TemporaryFolder folder;
  RunInto(MakeJointed(), folder / "run");
  RunInto(LoadScenario((folder / "run/scenario.yaml").string()), folder / "again");
  ReplayOptions options;
  options.run_folder = folder / "run";
  options.out = folder / "replay";
  Replay(options);
  for (const char* file :
       {"estimates/ekf/track.csv", "estimates/ekf/leaks.csv", "estimates/thesis/leaks.csv"}) {
    EXPECT_EQ(FileText((folder / "run") / file), FileText((folder / "replay") / file)) << file;
  }
  for (const char* file : {"truth/contacts.csv", "mav0/hydrophone0/audio.wav"}) {
    EXPECT_EQ(FileText((folder / "run") / file), FileText((folder / "again") / file)) << file;
  }
}

}  // namespace
}  // namespace piperun::scenarios
