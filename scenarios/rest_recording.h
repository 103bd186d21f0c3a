#pragma once

#include <memory>
#include <string>

#include "scenarios/assemble.h"
#include "scenarios/channel.h"
#include "scenarios/static_record.h"

namespace piperun::scenarios {

/// One channel from the start to the end, fed with the truth of a body that stays as it is.
class RestRecording {
 public:
  RestRecording(Channel& channel, const sim::TruthState& rest, Rate truth_rate);
  /// The next measurement, if it is due by `end`; null when it was lost. False: it is due later.
  bool Next(TrueTime end, const Measurement*& measurement);

 private:
  Channel& channel_;
  sim::TruthState state_;
  sim::TruthWindow window_;
  std::int64_t next_step_ = 0;
};

/// The record that RecordRest() would write of an inertial sensor, in memory: samples are made when they are
/// asked for. Groups gyro and accel; a lost sample ends a segment, stamps are taken as the sensor's rate.
/// Throws InputError when the scenario has no such sensor.
std::unique_ptr<StaticRecord> SimulateStaticRecord(const Scenario& scenario, const std::string& sensor,
                                                   double duration_s);

}  // namespace piperun::scenarios
