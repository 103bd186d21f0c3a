#include "sim/imu_triad.h"

#include <cmath>

namespace piperun::sim {
namespace {

int AxisOf(const std::string& name) { return name == "none" ? -1 : name.front() - 'x'; }

Vector3d ReadRegister(const Vector3d& value, const OutputRegister& output, unsigned& saturated) {
  for (int axis = 0; axis < 3; ++axis) {
    if (!output.Holds(value[axis])) saturated |= 1U << axis;
  }
  return output.Read(value);
}

}  // namespace

ImuTriad::ImuTriad(TriadType type, const TriadErrorParams& params, Rate rate, Rate physics_rate,
                   const TriadStream& stream)
    : stream_(stream),
      c_(MakeCoefficients(params, rate, stream)),
      front_end_{MakeImuFilter(params.filter, physics_rate), 0, c_.output.range},
      filtered_(params.filter.on()),
      stuck_axis_(AxisOf(params.stuck_axis)),
      stuck_from_s_(params.stuck_from_s) {
  c_.curvature.whole_force = type == TriadType::kGyroscope;
  if (filtered_) {  // the noise passes through the filters
    front_end_.noise_sd = params.noise / std::sqrt(physics_rate.Period_s());
    c_.noise_sd = 0;
  }
  state_.error = MakeState(c_, stream);
}

void ImuTriad::BeginSample(std::int64_t k, double warming_K) {
  StepDrift(state_.error, k, stream_, c_, warming_K);
  state_.drift = CalcBias(state_.error, c_);
  state_.white = StepWhite(state_.error, k, stream_, c_);
}

Vector3d ImuTriad::Read(const Vector3d& x, const Vector3d& f, unsigned& saturated) const {
  const Vector3d error = state_.drift + state_.white;
  return ReadRegister(CalcResponse(x, f, state_.error, c_) + error, c_.output, saturated);
}

Vector3d ImuTriad::StepFrontEnd(std::int64_t n, const Vector3d& x, const Vector3d& f, unsigned& saturated) {
  const Vector3d white = front_end_.noise_sd > 0 ? DrawStepNoise(n, stream_) : Vector3d(Vector3d::Zero());
  return sim::StepFrontEnd(state_.front_end, CalcResponse(x, f, state_.error, c_), white, state_.drift,
                           front_end_, saturated);
}

Vector3d ImuTriad::ReadFormed(const Vector3d& y, unsigned& saturated) const {
  return ReadRegister(y + state_.white, c_.output, saturated);
}

void ImuTriad::Stick(double t_s, double T_s, Vector3d& reading, std::optional<double>& held) const {
  if (stuck_axis_ < 0) return;
  if (held && t_s >= stuck_from_s_) {
    reading[stuck_axis_] = T_s * *held;
  } else {
    held = reading[stuck_axis_] / T_s;
  }
}

}  // namespace piperun::sim
