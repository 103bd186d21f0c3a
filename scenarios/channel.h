#pragma once

#include <memory>
#include <string>
#include <vector>

#include "acoustics/hydrophone.h"
#include "base/measurement.h"
#include "base/network.h"
#include "sim/motion.h"
#include "sim/sensor.h"
#include "sim/truth.h"

namespace piperun::scenarios {

/// One recording channel in the run loop, whatever records behind it.
class Channel {
 public:
  virtual ~Channel() = default;
  /// When the next measurement is complete, and how far beyond that the truth must reach to take it.
  virtual TrueTime due() const = 0;
  virtual Duration lookahead() const = 0;
  /// How much longer to wait while the motion goes on, until all collisions up to due() + lookahead() are
  /// told.
  virtual Duration contact_delay() const { return Duration(0); }
  /// A collision of the ball, told before the measurements that it begins in are taken.
  virtual void Hear(const sim::ContactEvent&) {}
  /// The longest stretch of truth a measurement looks back on.
  virtual Duration history() const = 0;
  /// Takes the next measurement; valid until the next call. Null: it was lost on its way.
  virtual const Measurement* Take(const sim::TruthWindow& window) = 0;
  /// What is only read out after the run; called once, behind the last Take().
  virtual std::vector<Measurement> ReadOut(const sim::TruthWindow&) { return {}; }
};

/// A channel over one of sim's sensors. `index` becomes Measurement::channel.
class SensorChannel : public Channel {
 public:
  SensorChannel(int index, std::unique_ptr<sim::Sensor> sensor, Rate truth_rate);
  TrueTime due() const override { return sensor_->DueTime(next_); }
  Duration lookahead() const override { return step_ + sensor_->lookahead(); }
  Duration history() const override { return sensor_->history(); }
  const Measurement* Take(const sim::TruthWindow& window) override;
  std::vector<Measurement> ReadOut(const sim::TruthWindow& window) override;
  const sim::Sensor& sensor() const { return *sensor_; }

 private:
  std::unique_ptr<sim::Sensor> sensor_;
  Duration step_;
  std::int64_t next_ = 0;
  Measurement measurement_;
};

/// A channel over the hydrophone. Its converter runs on the robot's clock: sample n is taken when that clock
/// shows n / rate after the start. Collisions are heard as knocks. Keeps a reference to the network.
class HydrophoneChannel : public Channel {
 public:
  HydrophoneChannel(int index, const acoustics::HydrophoneParams& params, acoustics::AcousticScene scene,
                    const RandomStream& random, const ClockModel& clock, const Network& network);
  TrueTime due() const override;
  Duration lookahead() const override;
  Duration contact_delay() const override { return sim::kContactEventDelay; }
  void Hear(const sim::ContactEvent& event) override;
  Duration history() const override;
  const Measurement* Take(const sim::TruthWindow& window) override;
  /// The sample that is taken at a true time or next before it.
  std::int64_t FindSample(TrueTime t) const;
  acoustics::Hydrophone& hydrophone() { return hydrophone_; }
  const acoustics::Hydrophone& hydrophone() const { return hydrophone_; }

 private:
  RobotTime StampOf(std::int64_t sample) const;

  bool soft_ball_;
  double rigid_contact_time_s_;
  acoustics::Hydrophone hydrophone_;
  ClockModel clock_;
  const Network& network_;
  std::int64_t next_sample_ = 0;
  std::vector<std::int32_t> counts_;
  Measurement measurement_;
};

/// What a hydrophone in the ball knows of its surroundings: the bore at its place, its slip |u - v . t| with
/// t the pipe's tangent along the way taken, and how fast it rolls or slides, |v . t| while it touches the
/// wall.
acoustics::ListenerState CalcListener(const sim::TruthState& truth, const Network& network);

/// How long a collision takes, as a half-sine of its impulse J and its peak force F, T = pi J/(2 F), when the
/// ball is soft: its contact is resolved in time. A rigid ball's is not, and takes `rigid_s`.
double CalcContactTime_s(const sim::ContactEvent& event, bool soft_ball, double rigid_s);

}  // namespace piperun::scenarios
