#pragma once

#include <array>
#include <vector>

#include "sim/network_spot.h"

namespace piperun::sim {

/// Strength of the flow across a pipe that bends make.
struct CrossStrength {
  Vector3d cells_W = Vector3d::Zero();  ///< of a pair of cells: core velocity over the bulk speed
  double swirl = 0;                     ///< of a single cell, 0 to 1; its sense switches (sim/swirl.h)
};

/// Strength at a place, and its derivative with s.
struct CrossGrowth {
  CrossStrength strength;
  CrossStrength slope_1_m;
};

/// How secondary flow comes and goes along the pipes of a network. Within a bend the vector a of the cells
/// relaxes within a diameter, behind it within five:
///
///   da/dx = (A g e - a)/D  in a bend,    da/dx = -a/(5 D)  on a straight,    g = min(1, 1.5 D/R_c)
///
/// x runs with the water, e points from the bend's centre outwards, and a is carried along the axis without
/// twist. The swirl obeys the same laws with A = 1. A is for bends of R_c <= 1.5 D; in gentler ones the
/// secondary vorticity is, as in Squire & Winter (J. Aeronaut. Sci. 18, 271 (1951)), in proportion to the
/// angle turned along a diameter. It goes on through smooth joints and begins at zero behind all others.
class SecondaryFlow {
 public:
  /// Keeps a reference.
  SecondaryFlow(const Bore& bore, double amplitude);

  /// `reversed`: the water runs from `to` to `from`. A pipe and what lies upstream of it are worked out when
  /// first met; nothing else allocates. Water that parts or meets at a smooth joint counts as running
  /// through.
  CrossGrowth Eval(const NetworkSpot& spot, bool reversed) const;

 private:
  struct Way {
    std::vector<CrossStrength> entry;  // where the water comes into each piece
    bool visited = false;              // a ring of smooth joints ends here
  };
  Way& FindOrMakeWay(int pipe, bool reversed) const;
  CrossStrength CalcEntry(int pipe, bool reversed) const;
  CrossGrowth EvalPiece(const Pipe& pipe, std::size_t piece, const CrossStrength& entry, double s_m,
                        bool reversed) const;

  const Bore& bore_;
  double amplitude_;
  mutable std::vector<std::array<Way, 2>> ways_;  // per pipe: with s, against s
};

/// Where a flow across the pipe is asked for.
struct CrossPlace {
  Vector3d axis_W = Vector3d::UnitX();      ///< t
  Vector3d curvature_W = Vector3d::Zero();  ///< kappa
  Vector3d offset_W = Vector3d::Zero();     ///< d, from the axis to the ball's centre
  double radius_m = 0;                      ///< R
  double radius_slope = 0;                  ///< dR/ds
  double ball_radius_m = 0;                 ///< b; 0: the flow at a point
};

/// Velocities of the cells and of the swirl with their derivatives along s. d(cells)/ds holds what the
/// turning of the axis makes of the vector.
struct CrossSpeed {
  Vector3d cells_W_m_s = Vector3d::Zero();  ///< w, across the pipe
  Vector3d cells_slope_W_1_s = Vector3d::Zero();
  double swirl_m_s = 0;  ///< c
  double swirl_slope_1_s = 0;

  /// False where nothing is left of the last bend's.
  bool Matters() const {
    constexpr double kNothing_m_s = 1e-12;
    constexpr double kNothing_1_s = 1e-12;
    const auto square = [](const Vector3d& v, double c) { return v.squaredNorm() + c * c; };
    return square(cells_W_m_s, swirl_m_s) > kNothing_m_s * kNothing_m_s ||
           square(cells_slope_W_1_s, swirl_slope_1_s) > kNothing_1_s * kNothing_1_s;
  }
};

struct CrossFlow {
  Vector3d velocity_W = Vector3d::Zero();
  Matrix3d gradient_1_s = Matrix3d::Zero();  ///< column j: derivative along axis j of W

  Vector3d Curl_1_s() const;
};

/// Two cells with stream function w R (r/R)(1 - (r/R)^2) sin(theta), w in the middle and 2 w back along the
/// walls, and a single one that turns with c (r/R)(1 - (r/R)^2), as means over the ball's disc,
///
///   u = k (p w - 2/R^2 (d . (t x w)) d x t + c/R p t x d),   p = 1 - (b^2 + r^2)/R^2,   k = 1/(1 - d .
///   kappa)
///
/// (the mean of a cubic f over a disc of radius b is f + b^2/8 laplace f). k makes it free of divergence in
/// bends, too. For b = 0 it is tangent to the wall. Exact gradient, the variation along s included.
CrossFlow CalcCrossFlow(const CrossPlace& place, const CrossSpeed& speed);

}  // namespace piperun::sim
