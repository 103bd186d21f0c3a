#pragma once

#include <optional>

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

  /// Puts the last reading before (or the first one) in place of an axis that is stuck by true time t.
  void StickRate(double t_s, Vector3d& rate) { Stick(t_s, 1, rate, state_.rate); }
  /// The same of an increment, whose mean over its T is not the rate where the triad turns meanwhile.
  void StickIncrement(double t_s, double T_s, Vector3d& sum) { Stick(t_s, T_s, sum, state_.increment); }

 private:
  void Stick(double t_s, double T_s, Vector3d& reading, std::optional<double>& held) const;

  struct State {
    TriadErrorState error;
    FrontEndState front_end;
    Vector3d drift = Vector3d::Zero();  ///< of this sample
    Vector3d white = Vector3d::Zero();
    std::optional<double> rate, increment;  ///< last readings of the axis that will be stuck
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
