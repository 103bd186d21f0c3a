#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/time.h"

namespace piperun::sim {

/// What a step of the physics may be asked to resolve. Reasons and figures: docs/physics.md, "Choice of the
/// step".
inline constexpr double kMaxStepRate_Hz = 10000;
inline constexpr double kMaxSpinPerStep_rad = 0.2;
inline constexpr double kMaxTurnPerStep_rad = 0.05;
inline constexpr double kMaxContactPhase_rad = 0.2;   ///< w_c dt up to which nothing is said
inline constexpr double kMostContactPhase_rad = 1.0;  ///< beyond, the contact is over within three steps
inline constexpr double kMaxDragStiffness = 0.5;      ///< 2 F dt/(M slip) up to which drag is left alone

/// w_c dt = sqrt(k/M) dt: the phase through which a contact of stiffness k swings a mass M in one step. The
/// ball leaves again after pi / (w_c dt) steps.
double CalcContactPhase_rad(double stiffness_N_m, double mass_kg, Rate rate);

/// Throws InputError (key ball.contact_stiffness_N_m) when a contact would be over within three steps, w_c dt
/// > 1. Mass: the one in the mass matrix, with the water that moves along.
void RequireResolvedContact(double stiffness_N_m, double mass_kg, Rate rate);

/// Whether the steps of a run were short enough for what they met: keeps the worst and says so at the end.
class StepResolution {
 public:
  /// `contact_phase_rad`: w_c dt of the ball's contact; 0: rigid.
  StepResolution(Rate rate, double contact_phase_rad) : rate_(rate), contact_phase_rad_(contact_phase_rad) {}

  /// One step: |w| of the ball, its speed, and the curvature of the pipe's axis there.
  void AddMotion(double spin_rad_s, double speed_m_s, double curvature_1_m);

  /// The share of the drag F that a step can resolve, from z = 2F dt/(M |slip|): how much of the slip it
  /// would take off, twice. The world's leapfrog with extrapolated velocities is stable for z < 1
  /// (amplification matrix [1-z, -z/2; -z, -z/2]). A ball that nearly fills its bore, in fast water, goes
  /// beyond: drag is then held to z < 0.9. Up to z = 1/2 nothing is changed; a usual run has z = 1e-3.
  double HoldDrag(double z);

  /// A sentence for everything that was under-resolved, with the figure, the limit and the least
  /// motion.rate_Hz that would do.
  std::vector<std::string> Warnings() const;

 private:
  Rate rate_;
  double contact_phase_rad_ = 0;
  double spin_per_step_rad_ = 0, turn_per_step_rad_ = 0, drag_stiffness_ = 0;  // the greatest met
  std::int64_t held_back_ = 0;                                                 // steps with less drag
};

}  // namespace piperun::sim
