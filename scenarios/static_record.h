#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace piperun::scenarios {

/// Channels of one sensor triad (or fewer) in one unit.
struct RecordGroup {
  std::string name;               ///< gyro, accel, mag, pressure, audio or the user's own
  std::string unit;               ///< SI: rad/s, m/s^2 ..
  std::vector<std::string> axes;  ///< columns, as the file names them
};

/// Where one kind of trouble was met.
struct RecordTrouble {
  std::int64_t count = 0;
  std::string first;  ///< file:line
};

/// What the reader met and did. Nothing is filled in: a row that is left out, or a gap, ends a segment.
struct RecordTiming {
  std::int64_t rows = 0;    ///< samples delivered
  double period_s = 0;      ///< of the even grid of times that the stamps lie about (scenarios/stamp_check.h)
  double jitter_sd_s = 0;   ///< of the stamps about it
  double jitter_max_s = 0;  ///< largest departure
  RecordTrouble gaps;       ///< where stamps skip times of the grid
  double missing_s = 0;     ///< periods skipped
  RecordTrouble duplicated;  ///< rows with the stamp of the row before: left out
  RecordTrouble not_finite;  ///< rows with an empty value, nan or inf: left out
  RecordTrouble corrupt;     ///< rows with another number of fields or no number in one: left out
};

struct RecordBlock {
  bool starts_segment = false;                ///< its first sample does not follow the last one delivered
  std::vector<std::vector<double>> channels;  ///< SI; groups one after the other; all equally long
};

struct StaticRecordOptions {
  /// (group, columns by name or number from 1). Empty: by the units in the header, "name [unit]".
  std::vector<std::pair<std::string, std::vector<std::string>>> columns;
  std::vector<std::pair<std::string, std::string>> units;  ///< (group, unit)
  std::string time_column;
  std::string time_unit;  ///< s, ms, us, ns; empty: the header's, else s
  std::optional<double> rate_Hz;
  double full_scale = 1;  ///< WAV: largest count, in the group's unit
};

/// A record of sensors at rest, read block by block.
class StaticRecord {
 public:
  virtual ~StaticRecord() = default;
  virtual const std::vector<RecordGroup>& groups() const = 0;
  /// The next samples; false at the end. Throws InputError with file and line for stamps that go back, and
  /// when more than one row in a hundred had to be left out.
  virtual bool Next(RecordBlock& block) = 0;
  virtual const RecordTiming& timing() const = 0;
  /// Sentences about what of the file was not taken.
  virtual std::vector<std::string> notes() const { return {}; }
  /// Share of the file that has been read.
  virtual double progress() const = 0;
};

/// A run folder (its mav0/imu0), a folder with a data.csv, a CSV file or a mono WAV or FLAC file. Throws
/// InputError when it is none, or when columns, units or the rate are missing or unknown.
std::unique_ptr<StaticRecord> OpenStaticRecord(const std::filesystem::path& path,
                                               const StaticRecordOptions& options);

}  // namespace piperun::scenarios
