#include "sim/stream_fluctuations.h"

#include <cmath>
#include <numbers>
#include <tuple>

#include "sim/pipe_flow.h"
#include "sim/random_oscillator.h"

namespace piperun::sim {
StreamFluctuations::StreamFluctuations(const StreamParams& params, std::uint64_t seed, std::uint64_t run,
                                       Rate rate, double ball_diameter_m, double response,
                                       double viscosity_m2_s)
    : turbulent_(params.turbulence.on),
      switching_(params.swirl_switching),
      coefficients_(CalcTurbulenceCoefficients(params.turbulence, ball_diameter_m, response)),
      turbulence_noise_(seed, "turbulence", run),
      swirl_noise_(seed, "swirl switching", run),
      period_s_(rate.Period_s()),
      viscosity_m2_s_(viscosity_m2_s) {
  if (turbulent_) state_.turbulence = StartTurbulence(turbulence_noise_.SixNormals(0, 0));
  if (!switching_) return;
  const auto start = swirl_noise_.SixNormals(0, 0);
  state_.swirl = start[0];
  state_.swirl_partner = start[1];
}

void StreamFluctuations::Step() {
  ++state_.step;
  if (turbulent_) {
    state_.turbulence =
        StepTurbulence(state_.turbulence, state_.local, coefficients_, state_.held,
                       turbulence_noise_.SixNormals(static_cast<std::uint64_t>(state_.step), 0), period_s_);
  }
  if (switching_) StepSwirl();
}

void StreamFluctuations::StepSwirl() {
  const double omega = state_.swirl_omega_1_s;
  if (omega == 0) return;
  const OscillatorStep step = CalcOscillatorStep(omega, kSwirlDamping * omega, period_s_);
  const auto n = swirl_noise_.SixNormals(static_cast<std::uint64_t>(state_.step), 0);
  std::tie(state_.swirl, state_.swirl_partner) =
      step.Advance(state_.swirl, state_.swirl_partner, 0.0, n[0], n[1]);
}

Swirl StreamFluctuations::swirl() const {
  return {state_.swirl, state_.swirl_omega_1_s * state_.swirl_partner};
}

TurbulentPlace StreamFluctuations::MakePlace(const NetworkSpot& spot, const Vector3d& p_L,
                                             const WaterAtBall& water) const {
  const double reynolds = 2 * water.bore_radius_m * std::abs(water.bulk_speed_m_s) / viscosity_m2_s_;
  const TurbulentPlace& last = state_.local.place;
  TurbulentPlace place{spot.axis.tangent_W, spot.axis.curvature_W, p_L - spot.axis.p_W, water.bore_radius_m,
                       water.friction_velocity_m_s};
  place.turbulent_fraction = CalcTurbulentFraction(reynolds);
  const bool same_bore = last.radius_m == place.radius_m;
  place.size_filter = same_bore ? last.size_filter : CalcSizeFilter(coefficients_, place.radius_m);
  return place;
}

void StreamFluctuations::AddTo(const NetworkSpot& spot, const Vector3d& p_L, WaterAtBall& water) {
  state_.swirl_omega_1_s =
      std::numbers::pi * kSwirlStrouhal * std::abs(water.bulk_speed_m_s) / water.bore_radius_m;
  if (!turbulent_) return;
  state_.local = CalcLocalTurbulence(MakePlace(spot, p_L, water), coefficients_);
  state_.held = water.wall_gap_m < kTouching_m;
  const WaterFluctuation fluctuation = CalcFluctuation(state_.turbulence, state_.local, water.velocity_W);
  water.velocity_W += fluctuation.velocity_W;
  water.acceleration_W += fluctuation.acceleration_W;
}

}  // namespace piperun::sim
