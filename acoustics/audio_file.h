#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>

namespace piperun::acoustics {

enum class AudioContainer { kWav, kFlac, kFloatWav };

/// One channel of whole numbers of +-2^(bits-1), which a float WAV holds as parts of 2^(bits-1): single
/// precision has them all.
struct AudioFormat {
  AudioContainer container = AudioContainer::kWav;
  std::int64_t rate_Hz = 16000;
  std::int64_t bits = 24;  ///< 16 or 24
};

/// Streams counts into a WAV or FLAC file, bit for bit, without time stamps (a float WAV has no PEAK chunk):
/// equal counts give equal files.
class AudioWriter {
 public:
  /// `expected_frames` is the most frames the file may get: a WAV that would not fit its 4 GiB limit is
  /// written as RF64 (EBU Tech 3306), which needs another header, any other as plain WAV. Throws InputError
  /// for a format that cannot be written, std::system_error when the file cannot be created.
  AudioWriter(const std::filesystem::path& path, const AudioFormat& format, std::int64_t expected_frames = 0);
  /// Closes without reporting errors; call Close() to hear of them.
  ~AudioWriter();
  AudioWriter(AudioWriter&&) noexcept;

  /// Appends counts of +-2^(bits-1). Throws std::system_error when the disk refuses (full, quota, I/O error)
  /// and std::length_error when a plain WAV outgrows 4 GiB.
  void Write(std::span<const std::int32_t> counts);
  /// Appends any numbers to a float WAV, as they are.
  void Write(std::span<const float> samples);
  /// Completes the header and closes the file; throws as Write does.
  void Close();

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

/// Streams counts back from a mono WAV or RF64 file of 16 or 24 bits or floats, or a FLAC file of 16 or 24
/// bits.
class AudioReader {
 public:
  /// A float WAV does not tell the bits of its counts: `float_bits`. Throws InputError when the file is
  /// missing, is no such file, or has another number of channels or bits.
  explicit AudioReader(const std::filesystem::path& path, std::int64_t float_bits = 24);
  ~AudioReader();
  AudioReader(AudioReader&&) noexcept;

  const AudioFormat& format() const;
  std::int64_t frames() const;
  /// Fills `counts` from where the last call ended and returns how many there were; fewer than asked for only
  /// at the end. Throws InputError when the file ends before the frames its header promises, and for a number
  /// of a float WAV that is no count.
  std::size_t Read(std::span<std::int32_t> counts);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace piperun::acoustics
