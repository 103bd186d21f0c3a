#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>

namespace piperun::acoustics {

/// Streams one channel of any sound file that libsndfile reads, as parts of full scale: whole numbers from -1
/// to 1, floating-point files as they are.
class SoundFile {
 public:
  /// Throws InputError when the file is missing, is no sound file, is empty or has more than one channel.
  explicit SoundFile(const std::filesystem::path& path);
  ~SoundFile();
  SoundFile(SoundFile&&) noexcept;

  double rate_Hz() const;
  std::int64_t frames() const;
  /// Reads on from there. Range: 0 to frames().
  void SeekTo(std::int64_t frame);
  /// Fills `samples` from where the last call ended and returns how many there were; 0 at the end.
  std::size_t Read(std::span<double> samples);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace piperun::acoustics
