#pragma once

#include <cstdint>
#include <string_view>

#include "base/random.h"
#include "base/time.h"
#include "sim/flow_field.h"
#include "sim/swirl.h"
#include "sim/turbulence.h"

namespace piperun::sim {

/// The random part of the flow that a ball meets in one run: turbulence and swirl switching. Every number of
/// step n comes from (seed, "turbulence" or "swirl switching", run, sample n), so that switching one of them
/// on changes nothing of the other.
class StreamFluctuations {
 public:
  /// What moves, as a value: save it, restore it, and a run goes on as if nothing had been.
  struct State {
    std::int64_t step = 0;
    TurbulenceState turbulence;
    double swirl = 0, swirl_partner = 0;
    /// Where the water was met last: the next step's coefficients.
    LocalTurbulence local;
    bool held = false;
    double swirl_omega_1_s = 0;
  };

  /// `response`: chi of sim/turbulence.h.
  StreamFluctuations(const StreamParams& params, std::uint64_t seed, std::uint64_t run, Rate rate,
                     double ball_diameter_m, double response, double viscosity_m2_s);

  /// To the next sample, with the coefficients of the place met last.
  void Step();
  /// At the present sample, for FlowField::Eval.
  Swirl swirl() const;
  /// Adds the turbulence of the present sample to the mean flow at a ball with centre at p_L, and keeps the
  /// place for the next step. Asking again changes nothing. A ball that touches the wall counts as held.
  void AddTo(const NetworkSpot& spot, const Vector3d& p_L, WaterAtBall& water);

  const State& state() const { return state_; }
  void Restore(const State& state) { state_ = state; }

 private:
  void StepSwirl();
  TurbulentPlace MakePlace(const NetworkSpot& spot, const Vector3d& p_L, const WaterAtBall& water) const;

  bool turbulent_, switching_;
  TurbulenceCoefficients coefficients_;
  RandomStream turbulence_noise_, swirl_noise_;
  double period_s_;
  double viscosity_m2_s_;
  State state_;
};

}  // namespace piperun::sim
