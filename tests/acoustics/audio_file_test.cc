#include "acoustics/audio_file.h"

#include <gtest/gtest.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <system_error>

#include "base/check.h"
#include "base/random.h"

namespace piperun::acoustics {
namespace {

namespace fs = std::filesystem;

/// A fresh folder per test.
class AudioFile : public testing::Test {
 public:
  ~AudioFile() override { fs::remove_all(folder_); }

 protected:
  AudioFile() {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::path(testing::TempDir()) / ("piperun_audio_" + std::string(test->name()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }

  static std::string Bytes(const fs::path& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }

  fs::path folder_;
};

/// Counts over the whole range of a converter, its ends included.
std::vector<std::int32_t> MakeCounts(std::size_t n, std::int64_t bits) {
  const RandomStream random(5, "counts", 0);
  std::vector<std::int32_t> counts{-(1 << (bits - 1)), (1 << (bits - 1)) - 1, 0, 1, -1};
  while (counts.size() < n) {
    counts.push_back(static_cast<std::int32_t>(random.Bits(counts.size(), 0)[0]) >> (32 - bits));
  }
  return counts;
}

void WriteInBlocks(const fs::path& path, const AudioFormat& format, std::span<const std::int32_t> counts,
                   std::size_t block) {
  AudioWriter writer(path, format);
  while (!counts.empty()) {
    const std::size_t n = std::min(block, counts.size());
    writer.Write(counts.first(n));
    counts = counts.subspan(n);
  }
  writer.Close();
}

const AudioFormat kFormats[] = {{AudioContainer::kWav, 16000, 16},
                                {AudioContainer::kWav, 96000, 24},
                                {AudioContainer::kFloatWav, 16000, 24},
                                {AudioContainer::kFlac, 8000, 16},
                                {AudioContainer::kFlac, 44100, 24}};

TEST_F(AudioFile, ReturnsEveryCountBitForBit) {
  for (const AudioFormat& format : kFormats) {
    const auto counts = MakeCounts(50000, format.bits);
    WriteInBlocks(folder_ / "audio", format, counts, 1600);
    AudioReader reader(folder_ / "audio");
    EXPECT_EQ(reader.format().container, format.container);
    EXPECT_EQ(reader.format().rate_Hz, format.rate_Hz);
    EXPECT_EQ(reader.format().bits, format.bits);
    EXPECT_EQ(reader.frames(), 50000);
    std::vector<std::int32_t> back(counts.size() + 100);
    std::size_t n = 0;
    while (const std::size_t got = reader.Read(std::span(back).subspan(n, 777))) {
      n += got;
      if (n + 777 > back.size()) break;
    }
    n += reader.Read(std::span(back).subspan(n));
    back.resize(n);
    EXPECT_EQ(back, counts);
  }
}

TEST_F(AudioFile, EqualCountsGiveEqualFilesWhateverTheBlocks) {
  for (const AudioFormat& format : kFormats) {
    const auto counts = MakeCounts(20000, format.bits);
    WriteInBlocks(folder_ / "a", format, counts, 1600);
    WriteInBlocks(folder_ / "b", format, counts, 20000);
    EXPECT_EQ(Bytes(folder_ / "a"), Bytes(folder_ / "b"));
  }
}

TEST_F(AudioFile, WavIsAPlainHeaderAndLittleEndianSamples) {
  WriteInBlocks(folder_ / "a.wav", {AudioContainer::kWav, 16000, 24},
                std::vector<std::int32_t>{1, -2, 0x123456}, 3);
  const std::string expected{
      "RIFF"
      "\x2e\0\0\0"
      "WAVE"
      "fmt "
      "\x10\0\0\0"
      "\x01\0"
      "\x01\0"
      "\x80\x3e\0\0"
      "\x80\xbb\0\0"
      "\x03\0"
      "\x18\0"
      "data"
      "\x09\0\0\0"
      "\x01\0\0"
      "\xfe\xff\xff"
      "\x56\x34\x12"
      "\0",
      54};
  EXPECT_EQ(Bytes(folder_ / "a.wav"), expected);
}

TEST_F(AudioFile, AWavThatMayOutgrowFourGibibytesIsRf64) {
  const auto counts = MakeCounts(1000, 24);
  {
    AudioWriter writer(folder_ / "a.wav", {AudioContainer::kWav, 96000, 24}, std::int64_t{96000} * 86400);
    writer.Write(counts);
    writer.Close();
  }
  EXPECT_EQ(Bytes(folder_ / "a.wav").substr(0, 4), "RF64");
  AudioReader reader(folder_ / "a.wav");
  EXPECT_EQ(reader.format().container, AudioContainer::kWav);
  std::vector<std::int32_t> back(1000);
  EXPECT_EQ(reader.Read(back), 1000u);
  EXPECT_EQ(back, counts);
}

TEST_F(AudioFile, AFloatWavHoldsPartsOfFullScaleAndNoTime) {
  WriteInBlocks(folder_ / "a.wav", {AudioContainer::kFloatWav, 16000, 24},
                std::vector<std::int32_t>{1 << 22, -(1 << 23), 1}, 3);
  const std::string bytes = Bytes(folder_ / "a.wav");
  EXPECT_EQ(bytes.find("PEAK"), std::string::npos);
  const float expected[] = {0.5F, -1, 0x1p-23F};
  float samples[3];
  std::memcpy(samples, bytes.data() + bytes.size() - sizeof(samples), sizeof(samples));
  for (int i = 0; i < 3; ++i) EXPECT_EQ(samples[i], expected[i]);
}

TEST_F(AudioFile, RefusesFloatsThatAreNoCounts) {
  AudioWriter writer(folder_ / "a.wav", {AudioContainer::kFloatWav, 16000, 24});
  writer.Write(std::vector<float>{0.5F, 1e-9F});
  writer.Close();
  AudioReader reader(folder_ / "a.wav");
  std::vector<std::int32_t> counts(2);
  EXPECT_THROW(reader.Read(counts), InputError);
}

TEST_F(AudioFile, SaysThatTheDiskIsFull) {
  for (const AudioFormat& format : kFormats) {
    try {
      AudioWriter writer("/dev/full", format);
      writer.Write(MakeCounts(100000, format.bits));
      writer.Close();
      ADD_FAILURE() << "a full disk went unnoticed";
    } catch (const std::system_error& e) {
      EXPECT_EQ(e.code().value(), ENOSPC);
      EXPECT_NE(std::string(e.what()).find("/dev/full"), std::string::npos);
    }
  }
}

TEST_F(AudioFile, SaysThatItCannotCreateAFile) {
  try {
    AudioWriter writer(folder_ / "no" / "such" / "folder.wav", {});
    ADD_FAILURE();
  } catch (const std::system_error& e) {
    EXPECT_EQ(e.code().value(), ENOENT);
  }
}

TEST_F(AudioFile, RefusesAFormatThatCannotBeWritten) {
  EXPECT_THROW(AudioWriter(folder_ / "a", {AudioContainer::kWav, 16000, 20}), InputError);
  EXPECT_THROW(AudioWriter(folder_ / "a", {AudioContainer::kWav, 0, 16}), InputError);
  EXPECT_FALSE(fs::exists(folder_ / "a"));
}

TEST_F(AudioFile, ReaderRefusesWhatItCannotRead) {
  EXPECT_THROW(AudioReader(folder_ / "missing.wav"), InputError);
  std::ofstream(folder_ / "text.wav") << "this is no sound";
  EXPECT_THROW(AudioReader(folder_ / "text.wav"), InputError);
  std::ofstream(folder_ / "empty.wav").flush();
  EXPECT_THROW(AudioReader(folder_ / "empty.wav"), InputError);
}

/// A WAV header written byte by byte, with room for eight bytes of samples.
std::string MakeWav(std::uint16_t tag, std::uint16_t channels, std::uint16_t bits) {
  std::string bytes("RIFF\x2c\0\0\0WAVEfmt \x10\0\0\0", 20);
  const auto append = [&](auto value) { bytes.append(reinterpret_cast<const char*>(&value), sizeof(value)); };
  append(tag);
  append(channels);
  append(std::uint32_t{8000});
  append(std::uint32_t{8000u * channels * bits / 8});
  append(static_cast<std::uint16_t>(channels * bits / 8));
  append(bits);
  return bytes + std::string("data\x08\0\0\0", 8) + std::string(8, '\0');
}

TEST_F(AudioFile, ReaderRefusesOtherChannelsAndSampleTypes) {
  const auto problem = [&](const std::string& bytes) -> std::string {
    std::ofstream(folder_ / "a.wav", std::ios::binary) << bytes;
    try {
      AudioReader reader(folder_ / "a.wav");
    } catch (const InputError& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_EQ(problem(MakeWav(1, 1, 16)), "");
  EXPECT_NE(problem(MakeWav(1, 2, 16)).find("2 channels"), std::string::npos);
  EXPECT_EQ(problem(MakeWav(3, 1, 32)), "");
  EXPECT_NE(problem(MakeWav(1, 1, 8)).find("16 or 24 bits"), std::string::npos);
  EXPECT_NE(problem(MakeWav(3, 1, 64)).find("16 or 24 bits"), std::string::npos);
}

TEST_F(AudioFile, ReaderNoticesAFlacCutShort) {
  WriteInBlocks(folder_ / "a.flac", {AudioContainer::kFlac, 16000, 24}, MakeCounts(50000, 24), 1600);
  fs::resize_file(folder_ / "a.flac", fs::file_size(folder_ / "a.flac") / 2);
  AudioReader reader(folder_ / "a.flac");
  std::vector<std::int32_t> counts(50000);
  EXPECT_THROW(reader.Read(counts), InputError);
}

}  // namespace
}  // namespace piperun::acoustics
