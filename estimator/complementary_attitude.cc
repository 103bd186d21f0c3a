#include "estimator/complementary_attitude.h"

namespace piperun::estimator {

void ComplementaryParams::Visit(ParamVisitor& v) {
  v.Number({"tilt_sd_rad", "Assumed error of the tilt, one sigma; the filter knows none."}, Range::Positive(),
           tilt_sd_rad);
  v.Number({"heading_sd_rad", "Assumed error of the heading while there is a compass, one sigma."},
           Range::Positive(), heading_sd_rad);
  v.Number({"heading_walk_rad_sqrts", "Assumed growth of the heading's error without one: random walk."},
           Range::NonNegative(), heading_walk_rad_sqrts);
  v.Number({"field_tolerance", "A field whose magnitude is off by more than this fraction is ignored."},
           Range::Positive(), field_tolerance);
  v.Number({"gyro_noise_rad_s_sqrtHz", "Assumed white noise of the gyro, by which a rest is told."},
           Range::Positive(), gyro_noise_rad_s_sqrtHz);
  v.Number({"gyro_bias_sd_rad_s", "Assumed turn-on bias, one sigma."}, Range::NonNegative(),
           gyro_bias_sd_rad_s);
}

HeadingVariance::HeadingVariance(const ComplementaryParams& params)
    : walk_rad2_s_(params.heading_walk_rad_sqrts * params.heading_walk_rad_sqrts),
      compass_rad2_(params.heading_sd_rad * params.heading_sd_rad) {}

double HeadingVariance::Update(double sd_rad) {
  const double gain = variance_rad2_ / (variance_rad2_ + sd_rad * sd_rad);
  variance_rad2_ *= 1 - gain;
  return gain;
}

}  // namespace piperun::estimator
