#pragma once

#include <cmath>
#include <numbers>
#include <vector>

#include "sim/ball_world.h"

namespace piperun::scenarios::physics {

/// The reference case, from which expected values are derived by hand: a ball of 60 mm and relative density
/// 1.10 in a bore of 150 mm, water of 1000 kg/m3, added mass 1/2.
struct ReferenceBall {
  static constexpr double radius_m = 0.03;
  static constexpr double bore_radius_m = 0.075;
  static constexpr double run_m =
      bore_radius_m - radius_m;  ///< the centre runs at this distance from the axis
  static constexpr double volume_m3 = 4.0 / 3.0 * std::numbers::pi * radius_m * radius_m * radius_m;
  static constexpr double mass_kg = 1100 * volume_m3;
  static constexpr double inertial_kg = mass_kg + 500 * volume_m3;  ///< m + m_a
  static constexpr double inertia_kg_m2 = 0.4 * mass_kg * radius_m * radius_m;
  static constexpr double rolling_kg = inertial_kg + inertia_kg_m2 / (radius_m * radius_m);
  static constexpr double gravity_m_s2 = 9.80665;
  static constexpr double weight_N = (mass_kg - 1000 * volume_m3) * gravity_m_s2;  ///< in water
};

sim::TubeBall MakeReferenceBall(double friction, double rolling_length_m);

/// A pipe of the reference bore through the given points, with a ball to be put into it.
class PipeBench {
 public:
  explicit PipeBench(const std::vector<Vector3d>& points, double bend_radius_m = 0.3);
  PipeBench(const PipeBench&) = delete;
  PipeBench& operator=(const PipeBench&) = delete;

  const sim::Bore& bore() const { return bore_; }
  const Pipe& pipe() const { return network_.pipe(0); }
  /// At s along the pipe, `offset_W` from its axis.
  sim::BallStart Start(double s_m, const Vector3d& offset_W, const Vector3d& v_WB_W = Vector3d::Zero(),
                       const Vector3d& w_WB_W = Vector3d::Zero()) const;

 private:
  Network network_;
  sim::Bore bore_;
};

/// Weight in water and nothing else.
sim::BallLoad CalcReferenceWeight(const sim::BallInstant& ball);

}  // namespace piperun::scenarios::physics
