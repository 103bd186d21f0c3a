#pragma once

#include <span>

namespace piperun::estimator {

/// Where a leak lies, given that there is one.
struct PlacePosterior {
  double mean_m = 0;
  double sigma_m = 0;
  double low_m = 0;  ///< the 95 % credible interval's ends: as much probability below as above
  double high_m = 0;
};

/// Fuses what the sound says of a place with how well the track is known. The sound's log likelihood l is
/// tabulated at even steps of the track's chainage and continued between them by Catmull and Rom's cubic
/// (Computer Aided Geometric Design, 317, 1974); with a flat prior the place on the track has the density
///
///     p(x) = exp(l(x)) / int exp(l)
///
/// and the place in the pipe is x + e, e the track's own error there, normal with standard deviation
/// track_sd_m and independent of the sound: its density is the convolution of both. Units: m; l in nats.
/// Range: at least three values of l, step_m > 0, track_sd_m >= 0.
PlacePosterior CalcPlacePosterior(double first_m, double step_m, std::span<const double> log_likelihood,
                                  double track_sd_m);

}  // namespace piperun::estimator
