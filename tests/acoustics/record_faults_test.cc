#include "acoustics/record_faults.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/check.h"
#include "tests/acoustics/scenes.h"

namespace piperun::acoustics {
namespace {

const RandomStream kRandom(3, "hydrophone0", 0);

struct Record {
  std::vector<std::int32_t> counts;
  std::int64_t dropped = 0;
  std::int64_t clipped = 0;
};

Record RenderWith(const RecordFaultParams& faults, std::size_t samples, std::size_t block,
                  double rate_Hz = 16000) {
  HydrophoneParams params;
  params.rate_Hz = rate_Hz;
  params.faults = faults;
  AcousticScene scene = MakeQuietScene(MakePvcWave());
  scene.ambient.distant_level_dB_re_1uPa2_Hz = 100;  // flat: 9 Pa, whose tenfold does not clip
  Hydrophone hydrophone(params, scene, kRandom);
  Record record;
  record.counts.resize(samples);
  for (std::size_t i = 0; i < samples; i += block) {
    hydrophone.Render(StillAt(10), std::span(record.counts).subspan(i, std::min(block, samples - i)));
  }
  record.dropped = hydrophone.dropped_samples();
  record.clipped = hydrophone.clipped_samples();
  return record;
}

std::string KeyRefused(const RecordFaultParams& faults) {
  try {
    RenderWith(faults, 1, 1);
  } catch (const InputError& e) {
    return e.key_path();
  }
  return "";
}

TEST(RecordFaults, AGainHoldsFromItsSampleOnUntilTheNext) {
  const Record plain = RenderWith({}, 16000, 1600);
  const Record stepped = RenderWith({.gain_steps = {{0.25, 20}, {0.5, -6}}, .drop_outs = {}}, 16000, 1600);
  for (std::size_t n = 0; n < plain.counts.size(); ++n) {
    const double gain = n < 4000 ? 1 : n < 8000 ? 10 : std::pow(10, -0.3);
    ASSERT_NEAR(stepped.counts[n], gain * plain.counts[n],
                0.5 * (1 + gain) + 1e-7 * gain * std::abs(plain.counts[n]))
        << n;
  }
}

TEST(RecordFaults, AGainThatIsTooHighClips) {
  EXPECT_EQ(RenderWith({}, 16000, 1600).clipped, 0);
  EXPECT_GT(RenderWith({.gain_steps = {{0.5, 60}}, .drop_outs = {}}, 16000, 1600).clipped, 0);
}

TEST(RecordFaults, ZerosStandWhereTheRecordDropsOutAndAreCounted) {
  const Record plain = RenderWith({}, 16000, 1600);
  const Record holed =
      RenderWith({.gain_steps = {}, .drop_outs = {{0.1, 0.2}, {0.15, 0.25}, {0.9, 7}}}, 16000, 1600);
  for (std::size_t n = 0; n < plain.counts.size(); ++n) {
    const bool lost = (n >= 1600 && n < 4000) || n >= 14400;
    ASSERT_EQ(holed.counts[n], lost ? 0 : plain.counts[n]) << n;
  }
  EXPECT_EQ(holed.dropped, 2400 + 1600);
}

TEST(RecordFaults, RandomDropOutsComeAtTheirRateAndWithTheirLength) {
  const Record record = RenderWith(
      {.gain_steps = {}, .drop_outs = {}, .drop_outs_1_h = 720, .drop_out_s = 0.03}, 4000 * 1000, 4000, 1000);
  // one per second with probability 0.2: 800 +- 25 in 4000 s, of 30 samples each. Two that meet share some:
  // 0.03 s of the second before, 800 * 0.2 * 0.03 / 2 of them by 10 samples on average, below 0.1 %.
  EXPECT_NEAR(static_cast<double>(record.dropped) / 30, 800, 4 * 25.3);
}

TEST(RecordFaults, DoNotDependOnTheSizeOfTheBlocks) {
  const RecordFaultParams faults{
      .gain_steps = {{0.3, 6}}, .drop_outs = {{1, 1.01}}, .drop_outs_1_h = 3000, .drop_out_s = 0.4};
  const Record whole = RenderWith(faults, 48000, 48000);
  EXPECT_GT(whole.dropped, 160);
  for (const std::size_t block : {1U, 777U, 1600U}) {
    const Record blocks = RenderWith(faults, 48000, block);
    EXPECT_EQ(blocks.counts, whole.counts) << block;
    EXPECT_EQ(blocks.dropped, whole.dropped) << block;
  }
}

TEST(RecordFaults, TimesThatRunBackwardsAreRefused) {
  EXPECT_EQ(KeyRefused({.gain_steps = {{2, 0}, {2, 6}}, .drop_outs = {}}), "faults.gain_steps[1].t_s");
  EXPECT_EQ(KeyRefused({.gain_steps = {}, .drop_outs = {{1, 2}, {3, 3}}}), "faults.drop_outs[1].end_s");
}

}  // namespace
}  // namespace piperun::acoustics
