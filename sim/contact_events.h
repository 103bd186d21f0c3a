#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "base/time.h"
#include "sim/ball_world.h"
#include "sim/motion.h"
#include "sim/network_spot.h"

namespace piperun::sim {

/// Where the ball is at an instant.
struct ContactPlace {
  Vector3d p_WB = Vector3d::Zero();
  int pipe = -1;
  double s_m = 0;
  double chainage_m = 0;
};

/// One step of a ball, as far as collisions are concerned; its contacts come beside it.
struct ContactStep {
  TrueTime time{};  ///< the instant in the middle of the step
  double dt_s = 0;
  double carried_force_N = 0;  ///< what a wall that the ball merely follows must bear; CalcCarriedForce_N
  ContactPlace place;
};

/// The most that the wall of a pipe must bear from a ball that follows it,
///
///   F_c = |F| + M (v_s^2 kappa + v_c^2 / rho),
///
/// F everything that acts on the ball but the wall, M its inertia with the added mass, v_s its speed along
/// the pipe, v_c the one around it, kappa the curvature of the axis, rho = max(|d|, 1 mm) the radius of its
/// path around the axis, d from the axis to its centre. A bound by the triangle inequality (mechanics); exact
/// for a ball that rests on the invert.
double CalcCarriedForce_N(double load_N, double mass_kg, const CentrelinePoint& axis, const Vector3d& p_LB,
                          const Vector3d& v_WB_W);

/// Tells collisions from resting, rolling and following the wall, out of what the contacts did step by step.
///
/// A step of a contact *strikes* when its closing speed exceeds v_0 + 2 F_c dt/M: what carries a ball closes
/// by F_c dt/M a step. An event opens with a striking step. Later contacts of the same feature, with a normal
/// within 45 degrees of its last one, belong to it when they strike or still *press* with more than
/// 2 F_c + M v_0/T_max. It ends when nothing has done so for 5 ms, one step at least (a rebound shorter than
/// that is chatter), or T_max = 0.1 s after it began. A rigid contact takes one or two steps (the first may
/// leave the rest of the gap to the second), a soft one as long as it takes to turn the ball round.
///
/// An event sums the impulses of its striking and pressing steps. Of a rigid impact it is M v_n (1 + e) with
/// an error of at most F_c dt, whatever the step. Its duration, and in rigid contacts its peak force, are
/// those of whole steps.
///
/// No allocation. Every event is told within kContactEventDelay of its beginning.
class ContactEventDetector {
 public:
  /// Opens at `least_speed_m_s` > 0, v_0.
  ContactEventDetector(double radius_m, double mass_kg, double least_speed_m_s)
      : radius_m_(radius_m), mass_kg_(mass_kg), least_speed_m_s_(least_speed_m_s) {}

  /// Steps come in order. Returns the events that ended with this one; valid until the next call.
  std::span<const ContactEvent> Step(const ContactStep& step, const StepContacts& contacts);
  /// Those of the last Step().
  std::span<const ContactEvent> ended() const { return {ended_.data(), ended_size_}; }

 private:
  static constexpr std::size_t kOpen = 8;

  struct OpenEvent {
    ContactEvent event;
    Vector3d normal_W = Vector3d::Zero();            // the last one
    Vector3d step_impulse_W_N_s = Vector3d::Zero();  // in the step at last_strike
    TrueTime last_strike{};                          // or press
    double most_carried_N = 0;
  };

  double CalcStrikeSpeed_m_s(double carried_force_N, double dt_s) const;
  bool Strikes(const StepContact& contact, const ContactStep& step) const;
  bool Presses(const StepContact& contact, const ContactStep& step) const;
  OpenEvent* Find(const StepContact& contact);
  void Take(const StepContact& contact, const ContactStep& step);
  void Open(const StepContact& contact, const ContactStep& step);
  static void Add(const StepContact& contact, const ContactStep& step, OpenEvent& open);
  void EndOverdue(const ContactStep& step);
  void End(std::size_t i, double dt_s);

  double radius_m_;
  double mass_kg_;
  double least_speed_m_s_;
  std::array<OpenEvent, kOpen> open_{};  // by their beginnings
  std::size_t open_size_ = 0;
  std::array<ContactEvent, kOpen + StepContacts::kCapacity> ended_{};
  std::size_t ended_size_ = 0;
};

}  // namespace piperun::sim
