#pragma once

#include "sim/imu_error.h"
#include "sim/imu_front_end.h"

namespace piperun::sim {

enum class TriadType { kGyroscope, kAccelerometer };

/// One triad of an IMU with its errors: the chain of TriadErrorParams, either on the true input of a whole
/// interval (what is linear does not tell the mean of readings from the reading of the mean) or, with filters
/// or curvature, step by step in front of the samples. In the triad's unit u, in the sensor frame S.
class ImuTriad {
 public:
  ImuTriad(TriadType type, const TriadErrorParams& params, Rate rate, Rate physics_rate,
           const TriadStream& stream);

  /// Whether the interval's mean is not enough.
  bool needs_steps() const { return filtered_ || c_.curvature.on; }
  bool feels_temperature() const { return c_.has_scale_drift || c_.has_deterministic_drift; }
  Vector3d bias() const { return CalcBias(state_.error, c_); }

  /// Moves what drifts to sample k. Once per sample, in order, before anything is read.
  void BeginSample(std::int64_t k, double warming_K);
  /// The reading of a true input and specific force. Sets the bits of axes that met their range.
  Vector3d Read(const Vector3d& x, const Vector3d& f, unsigned& saturated) const;

  /// The chain up to the digital filter's output at physics step n. Once per step, in order.
  Vector3d StepFrontEnd(std::int64_t n, const Vector3d& x, const Vector3d& f, unsigned& saturated);
  /// The reading formed from such outputs.
  Vector3d ReadFormed(const Vector3d& y, unsigned& saturated) const;

  bool can_stick() const { return stuck_axis_ >= 0; }
  /// Notes the reading at true time t, for an axis that will be stuck.
  void Note(double t_s, const Vector3d& reading);
  /// The reading with a stuck axis at what was noted last.
  Vector3d HoldStuckAxis(const Vector3d& reading) const;

 private:
  struct State {
    TriadErrorState error;
    FrontEndState front_end;
    Vector3d drift = Vector3d::Zero();  ///< of this sample
    Vector3d white = Vector3d::Zero();
    double held = 0;  ///< last reading of the axis that will be stuck
    bool holds = false;
  };

  TriadStream stream_;
  TriadErrorCoefficients c_;
  FrontEnd front_end_;
  bool filtered_;
  int stuck_axis_;
  double stuck_from_s_;
  State state_;
};

}  // namespace piperun::sim
