#include "sim/soft_contact.h"

namespace piperun::sim {
namespace {

SoftForce CalcForceAtEnd(const ContactCompliance& compliance, double gap_m, double dt_s) {
  const double k = compliance.stiffness_N_m, d = k * dt_s + compliance.damping_N_s_m;
  return {d, gap_m > 0 ? -gap_m / dt_s : -k * gap_m / d};  // before the wall there is no force
}

}  // namespace

SoftForce CalcSoftForce(const ContactCompliance& compliance, const SoftApproach& approach, double dt_s) {
  if (approach.impact_rad_s * dt_s > kResolvedImpact_rad) {
    return CalcForceAtEnd(compliance, approach.gap_m, dt_s);
  }
  if (approach.gap_m >= 0) return {};
  const double spring = 0.25 * compliance.stiffness_N_m * dt_s, damper = 0.5 * compliance.damping_N_s_m;
  const double d = spring + damper;
  return {d, -(compliance.stiffness_N_m * approach.gap_m + (damper - spring) * approach.speed_m_s) / d};
}

}  // namespace piperun::sim
