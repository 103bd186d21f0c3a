#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "estimator/estimator.h"
#include "estimator/locator_choice.h"
#include "scenarios/geo_origin.h"
#include "scenarios/scenario.h"

namespace piperun::scenarios {

/// What stands along that pipe, as its drawings show it.
struct DetectFitting {
  std::string id;
  std::string kind = "valve";
  double chainage_m = 0;
  void Visit(ParamVisitor& v);
};

/// The pipe that a record comes from, as a user states it.
struct DetectPipe {
  std::string material = "pvc_u";
  WallParams wall;
  double diameter_m = 0;
  double wall_thickness_m = 0;
  std::optional<double> length_m;  ///< of the route; nothing: as far as the record goes
  double speed_m_s = 0.5;          ///< of the ball, when there is no track
  double speed_sd_m_s = 0;         ///< of that speed: how well it is known
  double start_chainage_m = 0;
  double full_scale_Pa = 1000;  ///< pressure of the file's largest sample
  std::vector<DetectFitting> fittings;
  std::vector<double> line_m;  ///< the axis in plan and height: rows of east, north, up; empty: not known
  GeoOrigin origin;
  estimator::LocatorChoice locator;
  void Visit(ParamVisitor& v);
};

/// Reads a pipe file, strict YAML.
DetectPipe LoadDetectPipe(const std::filesystem::path& path);

struct DetectOptions {
  std::filesystem::path audio;
  std::optional<DetectPipe> pipe;
  /// CSV with the header time_s,chainage_m or time_s,chainage_m,chainage_sd_m; empty: the pipe's constant
  /// speed.
  std::filesystem::path track;
  std::string locator{};  ///< a kind with default parameters; empty: the pipe file's, or the matched filter
  std::optional<double> speed_sd_m_s{};  ///< instead of the pipe file's
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
  std::string interval_holds;       ///< which errors the intervals of 95 % are made of, a sentence
  std::optional<GeoOrigin> origin;  ///< set: p_W of the leaks are places on earth
  std::vector<estimator::LeakEstimate> leaks;
  std::vector<DetectedLevel> levels;
};

/// Finds leaks in a recording of a hydrophone that passed them. Time counts from the first sample. Without a
/// pipe file or track a ball at 0.5 m/s is assumed and only times are of use. Throws InputError for a file
/// that is missing, no sound, of several channels, silent, not finite, clipped in more than one sample in a
/// hundred, or whose rate does not carry the locator's bands; for a track that does not rise in time or
/// leaves the record's time; for an uncertain speed beside a track.
///
/// Intervals hold the sound's place on the way and the way's own error: a constant speed v known to s_v
/// places the ball at x0 + v t with a standard deviation s_v t; a track with what its third column says.
Detections Detect(const DetectOptions& options);

/// {"schema": "piperun.detect/1", "audio", "locator", "duration_s", "detections": [{"time_s", "chainage_m",
/// "sigma_m", "interval_m" (95 %), "confidence", "at" (a fitting or null), "flow_m3_s", "flow_sigma_dB"}]};
/// chainage, sigma and interval are null where nothing was said of the way.
std::string WriteDetectionsJson(const Detections& detections);
std::string WriteDetectionsCsv(const Detections& detections);
/// Leaks as dig points (scenarios/dig_points.h). Throws InputError unless the pipe file gives line_m and
/// origin.
std::string WriteDetectionsGeoJson(const Detections& detections);
/// Levels of the band and of its ratio against chainage (time without a way), detections marked.
std::string DrawDetectionsSvg(const Detections& detections);

}  // namespace piperun::scenarios
