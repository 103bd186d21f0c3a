#include "sim/network/fixed_power.h"

#include "base/check.h"

namespace piperun::sim {

FixedPower::FixedPower(double exponent) : exponent_(exponent) {
  Demand(0 <= exponent && exponent <= 2, "the series of FixedPower is cut for exponents from 0 to 2");
  double coefficient = 1;
  for (std::size_t k = 0; k < a_.size(); ++k) {
    const auto order = static_cast<double>(k);
    a_[k] = coefficient *= (exponent - order) / (order + 1);
  }
  for (std::size_t i = 0; i < kParts; ++i) {
    const double inverse = 1 / (1 + (static_cast<double>(i) + 0.5) / kParts);
    parts_[i] = {inverse, std::pow(inverse, -exponent)};
  }
  for (std::size_t i = 0; i < scales_.size(); ++i) {
    scales_[i] = std::pow(std::ldexp(1.0, static_cast<int>(i) - 64), exponent);
  }
}

}  // namespace piperun::sim
