#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "estimator/estimator.h"
#include "estimator/locator_choice.h"
#include "scenarios/scenario.h"

namespace piperun::scenarios {

/// The pipe that a record comes from, as a user states it.
struct DetectPipe {
  std::string material = "pvc_u";
  WallParams wall;
  double diameter_m = 0;
  double wall_thickness_m = 0;
  std::optional<double> length_m;  ///< of the route; nothing: as far as the record goes
  double speed_m_s = 0.5;          ///< of the ball, when there is no track
  double start_chainage_m = 0;
  double full_scale_Pa = 1000;  ///< pressure of the file's largest sample
  estimator::LocatorChoice locator;
  void Visit(ParamVisitor& v);
};

/// Reads a pipe file, strict YAML.
DetectPipe LoadDetectPipe(const std::filesystem::path& path);

struct DetectOptions {
  std::filesystem::path audio;
  std::optional<DetectPipe> pipe;
  std::filesystem::path track;  ///< CSV with the header time_s,chainage_m; empty: the pipe's constant speed
  std::string locator{};  ///< a kind with default parameters; empty: the pipe file's, or the matched filter
};

/// Level along the record, for plotting: mean over a stretch of equal time.
struct DetectedLevel {
  double time_s = 0;
  double chainage_m = 0;
  double band_dB = 0;   ///< re 1 uPa, 1 to 4 kHz
  double ratio_dB = 0;  ///< over 200 to 1000 Hz
};

struct Detections {
  std::string audio, locator;
  double duration_s = 0;
  double rate_Hz = 0;
  bool placed = false;  ///< chainages mean something: a pipe file or a track was given
  std::int64_t full_scale_samples = 0;
  std::vector<estimator::LeakEstimate> leaks;
  std::vector<DetectedLevel> levels;
};

/// Finds leaks in a recording of a hydrophone that passed them. Time counts from the first sample. Without a
/// pipe file or track a ball at 0.5 m/s is assumed and only times are of use. Throws InputError for a file
/// that is missing, no sound, of several channels, silent, not finite, clipped in more than one sample in a
/// hundred, or whose rate does not carry the locator's bands; and for a track that does not rise in time or
/// leaves the record's time.
Detections Detect(const DetectOptions& options);

/// {"schema": "piperun.detect/1", "audio", "locator", "duration_s", "detections": [{"time_s", "chainage_m",
/// "sigma_m", "interval_m" (95 %), "confidence", "flow_m3_s", "flow_sigma_dB"}]}; chainage, sigma and
/// interval are null where nothing was said of the way.
std::string WriteDetectionsJson(const Detections& detections);
std::string WriteDetectionsCsv(const Detections& detections);
/// Levels of the band and of its ratio against chainage (time without a way), detections marked.
std::string DrawDetectionsSvg(const Detections& detections);

}  // namespace piperun::scenarios
