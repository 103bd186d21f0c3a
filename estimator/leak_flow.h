#pragma once

#include <optional>

#include "base/network.h"

namespace piperun::estimator {

/// What is assumed of a leak's jet when its flow is told from its sound.
struct JetModel {
  double relative_fluctuation = 2e-3;  ///< eps: rms of the fluctuating part of the flow over the flow
  double pressure_Pa = 3e5;            ///< inside minus outside
  double strouhal = 0.15;
  double discharge_coefficient = 0.6;
  double calibration_dB = 15;  ///< by which levels of the open literature differ, either way
};

struct FlowEstimate {
  double flow_m3_s = 0;
  double sigma_dB = 0;  ///< of 20 lg flow: the calibration's half width taken as two standard deviations, and
                        ///< the level's own
};

/// Flow of a turbulent jet whose sound has the mean square p^2 in a band at the hole. The jet makes the
/// volume velocity spectrum S_q = (eps Q)^2 g(f), g = (1 + (f/f_c)^2)^(-5/4) / (1.198 f_c), f_c = St U / d, U
/// = sqrt(2 dP / rho), Q = C_d pi/4 d^2 U, and in a pipe that goes on both ways the pressure Z_c q / 2, Z_c =
/// rho c / A with Korteweg's speed, so
///
///     p^2 = (Z_c / 2)^2 (eps Q)^2 int_band g df
///
/// solved for Q by bisection: the corner falls as the hole grows, but p^2 rises with Q throughout.
/// Water at 10 C. Nothing for p^2 <= 0 and for a flow outside 1e-9 to 1 m3/s.
std::optional<FlowEstimate> CalcLeakFlow(const JetModel& jet, const Pipe& pipe, double low_Hz, double high_Hz,
                                         double pressure_Pa2, double level_sigma_dB);

}  // namespace piperun::estimator
