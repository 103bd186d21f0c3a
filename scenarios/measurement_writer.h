#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "base/measurement.h"
#include "scenarios/scenario.h"

namespace piperun::scenarios {

/// Writes one channel's record under mav0/NAME: data.csv (and increments.csv, flags.csv), or audio;
/// sensor.yaml at the end.
class MeasurementWriter {
 public:
  virtual ~MeasurementWriter() = default;
  virtual void Write(const Measurement& measurement) = 0;
  /// How many audio samples are zeros because they were lost; to be told before Close().
  virtual void CountDropped(std::int64_t) {}
  /// Completes the files.
  virtual void Close() = 0;
};

struct RecordOptions {
  RobotTime start{};                 ///< stamp of audio sample 0
  std::string audio_format = "wav";  ///< wav, wav_float or flac
  double longest_s = 0;              ///< the run cannot be longer: decides whether a WAV needs 64-bit sizes
};

/// `entry` says what the channel is; `X_BS` goes into its sensor.yaml.
std::unique_ptr<MeasurementWriter> MakeMeasurementWriter(const SensorEntry& entry, const Pose& X_BS,
                                                         const RecordOptions& options,
                                                         const std::filesystem::path& folder);

/// What a replay must know of an audio record; part of its sensor.yaml.
struct AudioDescription {
  std::string file = "audio.wav";
  double rate_Hz = 0;
  std::int64_t block_samples = 0;
  std::int64_t bits = 24;
  double full_scale_Pa = 0;
  double scale_Pa = 0;
  std::int64_t start_ns = 0;
  std::int64_t clipped_samples = 0;
  std::int64_t dropped_samples = 0;
  void Visit(ParamVisitor& v);
};

}  // namespace piperun::scenarios
