#pragma once

#include <optional>
#include <string>

#include "sim/network/model.h"

namespace piperun::sim {

/// What a pump lifts at speed 1 and flow q: H = shutoff_head_m - coefficient q^exponent, unless it follows
/// its curve point by point or gives constant power (H = kPumpPower P / q).
struct PumpLaw {
  double shutoff_head_m = 0;
  double coefficient = 0;
  double exponent = 1;
  double first_flow_m3_s = 0;  ///< first guess of the flow: the design flow, or the middle of the curve
};

/// Fits H = a - b q^c to a curve's design point (EPANET: a = 4/3 of its head, no head at twice its flow) or
/// to three points that begin at no flow; follows any other curve. Rossman (2020), section 3.2. Nothing when
/// the curve does not fall; `problem` then says what is wrong.
std::optional<PumpLaw> CalcPumpLaw(PumpKind kind, const Curve& curve, std::string* problem = nullptr);

/// Which kind of pump a curve makes.
PumpKind FindPumpKind(const Curve& curve);

}  // namespace piperun::sim
