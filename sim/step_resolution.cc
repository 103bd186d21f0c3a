#include "sim/step_resolution.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/check.h"
#include "base/number.h"
#include "sim/figure.h"

namespace piperun::sim {
namespace {

/// The rate at which a figure that grows with the step comes down to its limit.
double CalcLeastRate_Hz(Rate rate, double figure, double limit) {
  return std::ceil(rate.Hz() * figure / limit);
}

std::string Advise(Rate rate, double figure, double limit) {
  const double least_Hz = CalcLeastRate_Hz(rate, figure, limit);
  if (least_Hz > kMaxStepRate_Hz) {
    return "it would take a motion.rate_Hz of " + FormatNumber(least_Hz) + ", beyond the " +
           FormatNumber(kMaxStepRate_Hz) + " allowed";
  }
  return "raise motion.rate_Hz to " + FormatNumber(least_Hz) + " at least";
}

}  // namespace

double CalcContactPhase_rad(double stiffness_N_m, double mass_kg, Rate rate) {
  return std::sqrt(stiffness_N_m / mass_kg) * rate.Period_s();
}

void RequireResolvedContact(double stiffness_N_m, double mass_kg, Rate rate) {
  const double phase = CalcContactPhase_rad(stiffness_N_m, mass_kg, rate);
  if (phase <= kMostContactPhase_rad) return;
  const double per_step = kMostContactPhase_rad * rate.Hz();
  throw InputError("a contact of " + FormatNumber(stiffness_N_m) + " N/m throws a ball of " +
                       FormatFigure(mass_kg) + " kg (with the water that moves along) back within " +
                       FormatFigure(std::numbers::pi / phase) +
                       " steps of the physics; allowed: 3 or more, up to " +
                       FormatFigure(per_step * per_step * mass_kg) + " N/m at this rate. " +
                       Advise(rate, phase, kMostContactPhase_rad) + ", or let the contact be rigid",
                   "ball.contact_stiffness_N_m");
}

void StepResolution::AddMotion(double spin_rad_s, double speed_m_s, double curvature_1_m) {
  const double dt_s = rate_.Period_s();
  spin_per_step_rad_ = std::max(spin_per_step_rad_, spin_rad_s * dt_s);
  turn_per_step_rad_ = std::max(turn_per_step_rad_, curvature_1_m * speed_m_s * dt_s);
}

double StepResolution::HoldDrag(double z) {
  constexpr double kMost = 0.9;
  if (z <= kMaxDragStiffness) return 1;
  ++held_back_;
  drag_stiffness_ = std::max(drag_stiffness_, z);
  const double room = kMost - kMaxDragStiffness;
  return (kMaxDragStiffness + room * -std::expm1(-(z - kMaxDragStiffness) / room)) / z;
}

std::vector<std::string> StepResolution::Warnings() const {
  std::vector<std::string> warnings;
  const auto warn = [&](const std::string& what, double figure, double limit) {
    warnings.push_back(what + "; " + Advise(rate_, figure, limit));
  };
  const auto right_angle = [](double per_step_rad) {
    return FormatFigure(0.5 * std::numbers::pi / per_step_rad);
  };
  if (spin_per_step_rad_ > kMaxSpinPerStep_rad) {
    warn("spin: the ball turned by up to " + FormatFigure(spin_per_step_rad_) + " rad in a step; beyond " +
             FormatFigure(kMaxSpinPerStep_rad) +
             " rad its IMU reads gravity and centripetal acceleration more than 0.2 % wrong",
         spin_per_step_rad_, kMaxSpinPerStep_rad);
  }
  if (turn_per_step_rad_ > kMaxTurnPerStep_rad) {
    warn("bends: the pipe turned by up to " + FormatFigure(turn_per_step_rad_) +
             " rad in a step, a right angle in " + right_angle(turn_per_step_rad_) +
             " steps; it should take " + right_angle(kMaxTurnPerStep_rad),
         turn_per_step_rad_, kMaxTurnPerStep_rad);
  }
  if (contact_phase_rad_ > kMaxContactPhase_rad) {
    warn("contact: ball and wall part after " + FormatFigure(std::numbers::pi / contact_phase_rad_) +
             " steps, and the step adds " + FormatFigure(0.5 * contact_phase_rad_) +
             " of the critical damping; it should add " + FormatFigure(0.5 * kMaxContactPhase_rad) +
             " at most",
         contact_phase_rad_, kMaxContactPhase_rad);
  }
  if (held_back_ > 0) {
    warn("drag was held back in " + std::to_string(held_back_) + " steps: it would have taken off " +
             FormatFigure(0.5 * drag_stiffness_) + " of the slip in one, and a step follows up to " +
             FormatFigure(0.5 * kMaxDragStiffness) + " (a ball that nearly fills its bore in fast water)",
         drag_stiffness_, kMaxDragStiffness);
  }
  return warnings;
}

}  // namespace piperun::sim
