#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>

#include "base/time.h"
#include "sim/network_spot.h"
#include "sim/rotary_inertia.h"
#include "sim/soft_contact.h"

namespace piperun::sim {

/// A sphere in a tube, whose mass may lie off its centre B. The mass matrix is the inertial one: the added
/// mass of the water belongs into it (sim/ball_mass.h).
struct TubeBall {
  double radius_m = 0;
  double mass_kg = 0;                  ///< M
  RotaryInertia inertia_B_kg_m2 = 0;   ///< about the centre of mass of M
  double friction = 0;                 ///< Coulomb coefficient at the wall
  double rolling_length_m = 0;         ///< b = c_rr r: resisting torque over normal force
  double spinning_length_m = 0;        ///< b_sp = c_sp r: the same for the torque about the normal
  double restitution = 0;              ///< e, of rigid contacts; with a compliance, its damping decides
  Vector3d p_BM_B = Vector3d::Zero();  ///< centre of mass of M
  std::optional<ContactCompliance> compliance = std::nullopt;  ///< none: rigid
};

/// The axes of a drawing L (sim/bore.h) are those of W; only positions need one.
struct BallStart {
  Pose X_LB;  ///< L: drawing of the spot's pipe
  Vector3d v_WB_W = Vector3d::Zero();
  Vector3d w_WB_W = Vector3d::Zero();
  NetworkSpot spot;
};

/// The ball at a whole step, as the loads on it need it; velocities to second order in the step.
struct BallInstant {
  TrueTime time{};
  Vector3d p_LB;
  Quaterniond q_WB;
  Vector3d v_WB_W;
  Vector3d w_WB_W;
  NetworkSpot spot;
};

struct BallLoad {
  Vector3d force_W_N = Vector3d::Zero();     ///< at B: everything but the wall, weight included
  Vector3d torque_W_N_m = Vector3d::Zero();  ///< about B
};

using BallLoadFunction = std::function<BallLoad(const BallInstant&)>;

/// What one contact did to the ball in the step around an instant.
struct StepContact {
  Vector3d normal_W;                          ///< unit, from the wall to the ball
  Vector3d impulse_W_N_s = Vector3d::Zero();  ///< of the wall on the ball, friction included
  double closing_speed_m_s = 0;               ///< of an impact (sim/impact.h); 0: it was following the wall
  int feature = -1;                           ///< as in WallFoot
};

/// The contacts of one step.
class StepContacts {
 public:
  static constexpr std::size_t kCapacity = 4;
  void Add(const StepContact& contact) {
    if (size_ < kCapacity) contacts_[size_++] = contact;
  }
  const StepContact* begin() const { return contacts_.data(); }
  const StepContact* end() const { return contacts_.data() + size_; }
  std::size_t size() const { return size_; }

 private:
  std::array<StepContact, kCapacity> contacts_{};
  std::size_t size_ = 0;
};

/// The ball at step n, complete.
struct BallState {
  TrueTime time{};
  Pose X_LB;                    ///< L: drawing of the spot's pipe
  Vector3d v_WB_W, w_WB_W;      ///< mean of the half steps before and after
  Vector3d a_WB_W, alpha_WB_W;  ///< their difference over the step
  Vector3d v_step_W;            ///< p = p_before + v_step dt, and the shift of `crossing`
  Vector3d dtheta_B_rad;        ///< R = R_before Exp(dtheta)
  NetworkSpot spot;
  std::optional<SpotMove::Crossing> crossing;  ///< the step that ended at `time` led into another pipe
  double normal_force_N = 0;  ///< of the wall on the ball, mean over the step around `time`, all contacts
  StepContacts contacts;      ///< those of that step
  std::int64_t rescues = 0;   ///< steps so far in which the centre had left the water; 0 in a sane network
};

/// A ball under given loads inside the bores of a network, in a Bullet scene.
///
/// Integrated leapfrog: v(n+1/2) = v(n-1/2) + dt (F_n + contact_n)/m, p(n+1) = p(n) + dt v(n+1/2), with half
/// a kick in the first step; turning alike in the angular momentum (sim/tumbling.h). F_n is evaluated at v_n
/// = v(n-1/2) + a(n-1) dt/2, so straight motion, tumbling, frictionless rocking and the rolling of an
/// eccentric ball are of second order; rolling friction on a turning contact normal is of first, and so are
/// impacts. Loads act at the sphere's centre B, everything told is about B; v_step = v_M - (R(n+1) - R(n))
/// p_BM/dt. The contact is rigid, with or without a rebound (sim/impact.h), or has a compliance; sliding
/// friction obeys Coulomb's cone, rolling resistance a disc of radius b N, spinning resistance b_sp N. The
/// state at step n needs the velocity half a step later: the world runs one step ahead of what it tells.
/// Where pipes meet, the ball goes wherever it is pushed.
class BallWorld {
 public:
  /// Keeps a reference to the bore. The ball must start inside the water, at its spot.
  BallWorld(const Bore& bore, const TubeBall& ball, Rate rate, const BallStart& start, BallLoadFunction load);
  ~BallWorld();

  const BallState& state() const;
  void Step();  ///< no allocation

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace piperun::sim
