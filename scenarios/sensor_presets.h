#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scenarios/kind_entry.h"

namespace piperun::scenarios {

/// The sensors of a real board: one section for every kind of sensor it has, each holding the keys of that
/// kind (`imu: {gyro: {..}, accel: {..}}`).
struct SensorPreset {
  std::string name;
  std::string description;
  std::vector<KindEntry> sections;
  bool from_file = false;  ///< the user's own, not of the library

  /// Null when the board has no sensor of this kind.
  const KindEntry* Find(std::string_view kind) const;
  /// "imu, magnetometer".
  std::string Kinds() const;
};

/// The boards of the library (assets/sensors/*.yaml, part of the binary; every value with its source there),
/// in alphabetical order.
std::span<const SensorPreset> SensorPresets();

/// A preset as the user names it: of the library, or a file of theirs in the same form (what `piperun allan
/// --preset` writes), looked for in `folder` unless its path is absolute. Throws InputError at `preset` for a
/// name that is neither, and with file and line for what is wrong in a file.
SensorPreset LoadSensorPreset(const std::string& preset, const std::filesystem::path& folder);

/// A scenario of nothing but the preset's sensors, each under its usual name (imu0, mag0, pressure0), on a
/// bench at 25 degC, where data sheets are measured. `preset` as for LoadSensorPreset().
std::string WritePresetScenario(const SensorPreset& loaded, const std::string& preset);

}  // namespace piperun::scenarios
