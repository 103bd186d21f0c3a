#include "scenarios/channel.h"

#include <cmath>
#include <numbers>

namespace piperun::scenarios {
namespace {

/// Puts a sensor's sample into a measurement; false when there is none.
struct Deliver {
  Measurement& measurement;
  bool operator()(const sim::LostSample&) const { return false; }
  template <class Sample>
  bool operator()(const Sample& sample) const {
    measurement.value = sample;
    return true;
  }
};

}  // namespace

SensorChannel::SensorChannel(int index, std::unique_ptr<sim::Sensor> sensor, Rate truth_rate)
    : sensor_(std::move(sensor)), step_(SampleOffset(1, truth_rate) + Duration(1)) {
  measurement_.channel = index;
}

const Measurement* SensorChannel::Take(const sim::TruthWindow& window) {
  return std::visit(Deliver{measurement_}, sensor_->Sample(next_++, window)) ? &measurement_ : nullptr;
}

std::vector<Measurement> SensorChannel::ReadOut(const sim::TruthWindow& window) {
  std::vector<Measurement> measurements;
  for (const MarkerPass& pass : sensor_->ReadOut(window)) {
    measurements.push_back({measurement_.channel, pass});
  }
  return measurements;
}

HydrophoneChannel::HydrophoneChannel(int index, const acoustics::HydrophoneParams& params,
                                     acoustics::AcousticScene scene, const RandomStream& random,
                                     const ClockModel& clock, const Network& network)
    : soft_ball_(scene.ball.gives_way),
      rigid_contact_time_s_(scene.ambient.impacts.contact_time_s),
      hydrophone_(params, std::move(scene), random),
      clock_(clock),
      network_(network),
      counts_(static_cast<std::size_t>(params.block_samples)) {
  measurement_.channel = index;
  measurement_.value = AudioBlock{{}, params.rate_Hz, params.scale_Pa(), counts_};
}

RobotTime HydrophoneChannel::StampOf(std::int64_t sample) const {
  return clock_.ToRobot(TrueTime{}) + SampleOffset(sample, hydrophone_.rate());
}

TrueTime HydrophoneChannel::due() const {
  return clock_.ToTrue(StampOf(next_sample_ + static_cast<std::int64_t>(counts_.size()) - 1));
}

Duration HydrophoneChannel::lookahead() const { return hydrophone_.lookahead(); }

Duration HydrophoneChannel::history() const {
  return SampleOffset(static_cast<std::int64_t>(counts_.size()), hydrophone_.rate()) +
         hydrophone_.lookahead();
}

void HydrophoneChannel::Hear(const sim::ContactEvent& event) {
  const Duration since_start = clock_.ToRobot(event.begin) - StampOf(0);
  hydrophone_.Add({TrueTime(since_start), event.impulse_W_N_s.norm(),
                   CalcContactTime_s(event, soft_ball_, rigid_contact_time_s_)});
}

const Measurement* HydrophoneChannel::Take(const sim::TruthWindow& window) {
  const RobotTime start = StampOf(0);
  const auto listener = [&](TrueTime recorder_time) {
    const TrueTime t = clock_.ToTrue(start + recorder_time.time_since_epoch());
    return CalcListener(sim::Interpolate(window, std::max(t, TrueTime{})), network_);
  };
  hydrophone_.Render(listener, counts_);
  next_sample_ += static_cast<std::int64_t>(counts_.size());
  std::get<AudioBlock>(measurement_.value).stamp = StampOf(next_sample_ - 1);
  return &measurement_;
}

std::int64_t HydrophoneChannel::FindSample(TrueTime t) const {
  return static_cast<std::int64_t>(
      std::floor(Seconds(clock_.ToRobot(t) - StampOf(0)) * hydrophone_.rate().Hz()));
}

double CalcContactTime_s(const sim::ContactEvent& event, bool soft_ball, double rigid_s) {
  if (!soft_ball || !(event.peak_force_N > 0)) return rigid_s;
  return std::numbers::pi / 2 * event.impulse_W_N_s.norm() / event.peak_force_N;
}

acoustics::ListenerState CalcListener(const sim::TruthState& truth, const Network& network) {
  acoustics::ListenerState listener;
  listener.pipe = truth.pipe;
  listener.s_m = truth.s_m;
  listener.water_speed_m_s = truth.water_speed_m_s;
  listener.time = truth.time;
  if (truth.pipe < 0) return listener;
  const Pipe& pipe = network.pipe(truth.pipe);
  listener.bore_radius_m = pipe.RadiusAt_m(truth.s_m);
  const double speed_along_pipe = truth.v_WB_W.dot(pipe.Eval(truth.s_m).tangent_W);
  const double ball_speed = truth.reversed ? -speed_along_pipe : speed_along_pipe;
  listener.slip_speed_m_s = std::abs(truth.water_speed_m_s - ball_speed);
  if (truth.contact) listener.rolling_speed_m_s = std::abs(speed_along_pipe);
  return listener;
}

}  // namespace piperun::scenarios
