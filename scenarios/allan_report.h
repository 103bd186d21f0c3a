#pragma once

#include <string>

#include "scenarios/allan_analysis.h"

namespace piperun::scenarios {

/// Everything that is known, SI: channels with terms, intervals, points of the deviation and notes.
std::string WriteAllanJson(const AllanAnalysis& analysis);

/// Throws InputError unless a record holds what Kalibr's file wants.
void RequireKalibrGroups(const std::vector<RecordGroup>& groups);

/// Kalibr's imu.yaml: densities and random walks of gyroscope and accelerometer, root mean square over the
/// axes. Where a random walk is not identifiable its upper bound is written and a comment says so. Of a
/// record that has both. Throws InputError when the white noise of one is not identifiable.
std::string WriteKalibrYaml(const AllanAnalysis& analysis);

/// A preset of sensors (scenarios/sensor_presets.h) whose section imu has the fitted noise: Q, N, B, K, R
/// and, where it was asked for, the Gauss-Markov process, root mean square over the axes. Terms that are not
/// identifiable are left out, and a comment gives their bound. Throws InputError when there is neither gyro
/// nor accel.
std::string WriteSensorPreset(const AllanAnalysis& analysis);

/// Log-log plot of the deviations, one panel per group, with the confidence of every point as a band, the fit
/// as a line and the terms of the first axis dashed.
std::string DrawAllanSvg(const AllanAnalysis& analysis);

}  // namespace piperun::scenarios
