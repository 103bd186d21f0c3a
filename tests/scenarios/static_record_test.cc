#include "scenarios/static_record.h"

#include <gtest/gtest.h>
#include <stdlib.h>

#include <cmath>
#include <fstream>
#include <numbers>

#include "acoustics/audio_file.h"
#include "base/check.h"
#include "base/number.h"
#include "base/random.h"

namespace piperun::scenarios {
namespace {

constexpr const char* kHeader = "#timestamp [ns],w_x [deg/s],note,a_z [mg]\n";

class StaticRecordTest : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string name = (std::filesystem::temp_directory_path() / "record-XXXXXX").string();
    ASSERT_TRUE(::mkdtemp(name.data()));
    folder_ = name;
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path File(const std::string& text, const std::string& name = "record.csv") {
    std::ofstream(folder_ / name) << text;
    return folder_ / name;
  }
  std::filesystem::path folder_;
};

/// Row k of a 100 Hz record: stamp, gyro 0.001 k deg/s, a word, accel k mg.
std::string Row(std::int64_t k) {
  return std::to_string(k * 10000000) + "," + FormatNumber(0.001 * static_cast<double>(k)) + ",x," +
         std::to_string(k) + "\n";
}

std::string Rows(std::int64_t begin, std::int64_t end) {
  std::string text;
  for (std::int64_t k = begin; k < end; ++k) text += Row(k);
  return text;
}

struct Whole {
  std::vector<std::size_t> segments;  ///< lengths
  std::vector<std::vector<double>> channels;
  RecordTiming timing;
};

Whole ReadAll(const std::filesystem::path& file, const StaticRecordOptions& options = {}) {
  const auto record = OpenStaticRecord(file, options);
  Whole whole;
  RecordBlock block;
  while (record->Next(block)) {
    if (block.starts_segment || whole.segments.empty()) whole.segments.push_back(0);
    whole.segments.back() += block.channels[0].size();
    whole.channels.resize(block.channels.size());
    for (std::size_t i = 0; i < block.channels.size(); ++i)
      whole.channels[i].insert(whole.channels[i].end(), block.channels[i].begin(), block.channels[i].end());
  }
  whole.timing = record->timing();
  return whole;
}

std::string Complaint(const std::filesystem::path& file, const StaticRecordOptions& options = {}) {
  try {
    ReadAll(file, options);
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

TEST_F(StaticRecordTest, ColumnsAndUnitsComeFromTheHeader) {
  const Whole whole = ReadAll(File(kHeader + Rows(0, 10000)));
  ASSERT_EQ(whole.channels.size(), 2U);
  EXPECT_EQ(whole.segments, std::vector<std::size_t>{10000});
  EXPECT_NEAR(whole.channels[0][9999], 9.999 * std::numbers::pi / 180, 1e-15);
  EXPECT_NEAR(whole.channels[1][9999], 9.999 * 9.80665, 1e-12);
  EXPECT_NEAR(whole.timing.period_s, 0.01, 1e-12);
  EXPECT_EQ(whole.timing.rows, 10000);
}

TEST_F(StaticRecordTest, GapsEndSegmentsAndAreCounted) {
  const Whole whole = ReadAll(File(kHeader + Rows(0, 5000) + Rows(5007, 9000) + Rows(9001, 9500)));
  EXPECT_EQ(whole.segments, (std::vector<std::size_t>{5000, 3993, 499}));
  EXPECT_EQ(whole.timing.gaps.count, 2);
  EXPECT_TRUE(whole.timing.gaps.first.ends_with(":5002")) << whole.timing.gaps.first;
  EXPECT_NEAR(whole.timing.missing_s, 0.08, 1e-9);
}

TEST_F(StaticRecordTest, RowsThatCannotBeUsedAreLeftOutAndCounted) {
  const std::string text = std::string(kHeader) + Rows(0, 4000) + "40000000000,nan,x,7\n" + Rows(4001, 6000) +
                           "60000000000,1\n" + Rows(6001, 6002) + "60020000000,1,x,q7\n" + Rows(6003, 7000) +
                           Row(6999) + Rows(7000, 8000);
  const Whole whole = ReadAll(File(text));
  EXPECT_EQ(whole.timing.not_finite.count, 1);
  EXPECT_TRUE(whole.timing.not_finite.first.ends_with(":4002"));
  EXPECT_EQ(whole.timing.corrupt.count, 2);
  EXPECT_TRUE(whole.timing.corrupt.first.ends_with(":6002"));
  EXPECT_EQ(whole.timing.duplicated.count, 1);
  EXPECT_EQ(whole.segments, (std::vector<std::size_t>{4000, 1999, 1, 1997}));
}

TEST_F(StaticRecordTest, StampsThatGoBackAreRefusedWithTheirLine) {
  const std::string said = Complaint(File(kHeader + Rows(0, 3000) + Rows(2990, 4000)));
  EXPECT_NE(said.find("record.csv:3002"), std::string::npos) << said;
  EXPECT_NE(said.find("lies before"), std::string::npos);
}

TEST_F(StaticRecordTest, MoreThanOneRowInAHundredIsTooMuch) {
  std::string text = kHeader;
  for (std::int64_t k = 0; k < 3000; ++k) text += k % 50 == 0 ? "?\n" : Row(k);
  const std::string said = Complaint(File(text));
  EXPECT_NE(said.find("record.csv:2"), std::string::npos) << said;
  EXPECT_NE(said.find("1 %"), std::string::npos) << said;
}

TEST_F(StaticRecordTest, JitterIsMeasured) {
  std::string text = kHeader;
  for (std::int64_t k = 0; k < 5000; ++k)
    text += std::to_string(k * 10000000 + (k % 2) * 1000000) + ",1,x," + std::to_string(k) + "\n";
  const Whole whole = ReadAll(File(text));
  EXPECT_EQ(whole.segments, std::vector<std::size_t>{5000});
  EXPECT_NEAR(whole.timing.period_s, 0.01, 1e-6);
  EXPECT_NEAR(whole.timing.jitter_sd_s, 0.0005, 1e-5);  // to either side of the middle
  EXPECT_NEAR(whole.timing.jitter_max_s, 0.0005, 1e-5);
}

/// Rows with stamps that scatter evenly by up to plus and minus `jitter` periods of 10 ms.
std::string JitteredRows(double jitter, double loss) {
  const RandomStream random(5, "stamps", 0);
  std::string text = kHeader;
  for (std::int64_t k = 0; k < 100000; ++k) {
    const auto u = random.Uniforms(static_cast<std::uint64_t>(k), 0);
    if (u[1] < loss) continue;
    const double place = static_cast<double>(k) + jitter * (2 * u[0] - 1);
    text += std::to_string(std::llround(place * 1e7) + 1000000000) + ",1,x," + std::to_string(k) + "\n";
  }
  return text;
}

TEST_F(StaticRecordTest, StampsThatJitterByFourTenthsOfAPeriodAreNoGaps) {
  for (const double jitter : {0.2, 0.3, 0.4}) {
    const Whole whole = ReadAll(File(JitteredRows(jitter, 0)));
    EXPECT_NEAR(whole.timing.period_s, 0.01, 1e-7) << jitter;
    EXPECT_EQ(whole.timing.gaps.count, 0) << jitter;
    EXPECT_NEAR(whole.timing.jitter_sd_s, 0.01 * jitter / std::sqrt(3.0), 1e-4) << jitter;
  }
}

TEST_F(StaticRecordTest, LossesAreTheGapsThatJitterIsNot) {
  const Whole whole = ReadAll(File(JitteredRows(0.3, 0.02)));
  EXPECT_NEAR(whole.timing.period_s, 0.01, 1e-7);
  EXPECT_NEAR(static_cast<double>(whole.timing.gaps.count), 0.02 * 0.98 * 100000, 5 * std::sqrt(2000.0));
  EXPECT_NEAR(whole.timing.missing_s, 0.01 * (100000 - static_cast<double>(whole.timing.rows)), 0.011);
}

TEST_F(StaticRecordTest, PlainFilesNeedColumnsUnitsAndARate) {
  const auto file = File("1,2\n3,4\n5,6\n", "plain.csv");
  EXPECT_NE(Complaint(file).find("--columns"), std::string::npos);
  StaticRecordOptions options;
  options.columns = {{"accel", {"2"}}};
  EXPECT_NE(Complaint(file, options).find("--unit accel=UNIT"), std::string::npos);
  options.units = {{"accel", "deg/s"}};
  options.rate_Hz = 50;
  EXPECT_NE(Complaint(file, options).find("m/s^2"), std::string::npos) << "a rate is no acceleration";
  options.units = {{"accel", "gee"}};
  EXPECT_NE(Complaint(file, options).find("'gee'"), std::string::npos);
  options.units = {{"accel", "g"}};
  options.rate_Hz.reset();
  EXPECT_NE(Complaint(file, options).find("--rate"), std::string::npos);
  options.rate_Hz = 50;
  const Whole whole = ReadAll(file, options);
  EXPECT_EQ(whole.channels[0].size(), 3U) << "the first row of a file without a header is data";
  EXPECT_NEAR(whole.channels[0][2], 6 * 9.80665, 1e-12);
  EXPECT_EQ(whole.timing.period_s, 0.02);
  options.columns = {{"accel", {"3"}}};
  EXPECT_NE(Complaint(file, options).find("'3'"), std::string::npos);
}

TEST_F(StaticRecordTest, SecondsAsStampsAreRead) {
  StaticRecordOptions options;
  options.columns = {{"gyro", {"w"}}};
  options.units = {{"gyro", "dps"}};
  const auto file = File("t,w\n0.0,1\n0.01,2\n0.02,3\n0.05,4\n", "seconds.csv");
  const Whole whole = ReadAll(file, options);
  EXPECT_EQ(whole.segments, (std::vector<std::size_t>{3, 1}));
}

TEST_F(StaticRecordTest, AudioIsARecord) {
  std::vector<std::int32_t> counts;
  for (int i = 0; i < 10000; ++i) counts.push_back(i - 5000);
  acoustics::AudioWriter writer(folder_ / "a.wav", {acoustics::AudioContainer::kWav, 8000, 16});
  writer.Write(counts);
  writer.Close();
  StaticRecordOptions options;
  options.units = {{"pressure", "Pa"}};
  options.full_scale = 64;
  const Whole whole = ReadAll(folder_ / "a.wav", options);
  EXPECT_EQ(whole.segments, std::vector<std::size_t>{10000});
  EXPECT_EQ(whole.channels[0][0], -5000.0 * 64 / 32768);
  EXPECT_EQ(whole.timing.period_s, 1.0 / 8000);
}

TEST_F(StaticRecordTest, FoldersAreSearched) {
  std::filesystem::create_directories(folder_ / "mav0/imu0");
  std::ofstream(folder_ / "mav0/imu0/data.csv") << kHeader << Rows(0, 200);
  EXPECT_EQ(ReadAll(folder_).timing.rows, 200);
  EXPECT_EQ(ReadAll(folder_ / "mav0/imu0").timing.rows, 200);
  EXPECT_NE(Complaint(folder_ / "none.csv"), "");
}

}  // namespace
}  // namespace piperun::scenarios
