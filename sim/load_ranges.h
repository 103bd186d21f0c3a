#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "sim/fluid_load.h"

namespace piperun::sim {

/// Watches whether a run stays within the ranges of the laws that act in it. Below their ranges nothing is
/// said: there the forces vanish, and every law goes over into Stokes'.
///
///   drag          the law's own Re (sim/drag.h), at |u-v|/f; 6e6 for rough and foam-covered balls
///   wall factor   d/D of the data (sim/wall_factor.h)
///   rolling drag  Re < 2e5, where the ball is nearer to the wall than its radius
///   spin torque   Re_w < 2e5
///   profile       Re of the pipe < 3.2e6 (power law), 3.5e7 (log law); and not between 2300 and 4000
class LoadRanges {
 public:
  LoadRanges(const FluidLoadCoefficients& coefficients, const WaterProperties& water, ProfileLaw profile);

  /// One step; a handful of comparisons.
  void Feed(const LoadNumbers& numbers, const WaterAtBall& water);

  /// One sentence per law whose range was left: law, range and how far the run went. Empty: all stayed
  /// inside.
  std::vector<std::string> Sentences() const;

 private:
  struct Watch {
    std::string law;     ///< "drag: Brown & Lawler is fitted for Re"
    std::string number;  ///< what went beyond, "the ball reached Re"
    double limit = 0;
    double most = 0;
  };

  std::array<Watch, 5> watches_;
  double wall_gap_m_;  ///< nearer, the rolling drag counts
  double bore_to_reynolds_s_m2_;
  double transitional_reynolds_ = 0;  ///< the largest between laminar and turbulent flow; 0: none
};

}  // namespace piperun::sim
