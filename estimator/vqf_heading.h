#pragma once

#include "base/params.h"
#include "base/pose.h"
#include "estimator/mean_low_pass.h"

namespace piperun::estimator {

struct VqfHeadingParams {
  double heading_s = 9;
  double current_s = 0.05;
  double reference_s = 20;
  double norm_tolerance = 0.1;
  double dip_tolerance_rad = 0.1745;
  double new_field_s = 20;
  double new_field_rate_rad_s = 0.349;
  double undisturbed_s = 0.5;
  double rejection_s = 60;
  double rejection_factor = 2;

  void Visit(ParamVisitor& v);
};

/// Heading correction delta of VQF, with its magnetic-disturbance rejection (Laidig & Seel 2023, sections 3.3
/// and 3.6): R_WS = R_z(delta) R_ES.
///
/// delta follows psi_ref - psi(m_E) by a first-order low pass, delta += (1 - exp(-dt/tau)) (...), the gain
/// starting at 1, 1/2, 1/3 ..., so that the first field aligns at once. A field is disturbed unless magnitude
/// and dip, low-passed, have been those of the reference for `undisturbed_s`; the reference then follows
/// them. A disturbed field is left out for `rejection_s`, then followed at a rate lower by
/// `rejection_factor`. A field that stays the same for `new_field_s` while the sensor turns becomes the new
/// reference. dip: positive when the field points down.
class VqfHeading {
 public:
  /// `field_W_T`: the reference, not zero.
  VqfHeading(const VqfHeadingParams& params, const Vector3d& field_W_T);

  /// `w_rad_s` magnitude of the sensor's rate, low-passed. False: the field was left out.
  bool Step(const Vector3d& m_E_T, double w_rad_s, double dt_s);
  void Turn(double offset_rad);

  double delta_rad() const { return delta_rad_; }
  bool disturbed() const { return disturbed_; }

 private:
  struct Field {
    double norm_T = 0, dip_rad = 0;
  };
  bool Agrees(const Field& field, const Field& with) const;
  void Judge(const Field& field, double dt_s);
  void ConsiderAsNew(const Field& field, double w_rad_s, double dt_s);
  double CalcGain(double dt_s);

  VqfHeadingParams params_;
  double psi_reference_rad_;
  Field reference_, candidate_;
  MeanLowPass<2> current_;
  double undisturbed_s_ = 0, candidate_s_ = 0, rejected_s_ = 0;
  double first_gain_ = 1;
  double delta_rad_ = 0;
  bool disturbed_ = true;
};

}  // namespace piperun::estimator
