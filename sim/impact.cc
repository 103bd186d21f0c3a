#include "sim/impact.h"

#include <algorithm>
#include <cmath>

namespace piperun::sim {

double CalcClosingSpeed_m_s(const WallApproach& approach, double dt_s) {
  const auto [z, v, a] = approach;
  if (v >= 0 || z + v * dt_s + 0.5 * a * dt_s * dt_s >= 0) return 0;
  const double speed_m_s = z > 0 ? std::sqrt(std::max(0.0, v * v - 2 * a * z)) : -v;
  return speed_m_s > std::abs(a) * dt_s ? speed_m_s : 0;
}

double CalcReboundGap_m(const WallApproach& approach, double restitution, double dt_s) {
  const double a = approach.acceleration_m_s2, z = std::max(0.0, approach.gap_m);
  const double closing_m_s = CalcClosingSpeed_m_s(approach, dt_s);
  if (restitution == 0 || closing_m_s <= std::max(kLeastImpactSpeed_m_s, 2 * std::abs(a) * dt_s)) return 0;
  const double leaving_m_s = restitution * closing_m_s;
  const double square = leaving_m_s * leaving_m_s + 2 * a * z;
  return square > 0 ? std::max(0.0, z + std::sqrt(square) * dt_s + 0.5 * a * dt_s * dt_s) : 0;
}

}  // namespace piperun::sim
