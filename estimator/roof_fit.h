#pragma once

#include <vector>

#include "estimator/sound_profile.h"

namespace piperun::estimator {

/// The level of a leak over its background along the pipe, when its power falls off exponentially both ways:
/// a roof in decibels, rounded where it meets the background,
///
///     m(x) = 10 lg(1 + rho 10^(-s |x - x0| / 10))
///
/// with slope s = 8.686 alpha (power falls as exp(-2 alpha |x|)) and height 10 lg rho. Tabulated once: linear
/// between 4096 points, zero beyond `reach_m`.
class Roof {
 public:
  Roof(double slope_dB_m, double height_dB, double reach_m);
  double Level_dB(double offset_m) const {
    const double at = (offset_m < 0 ? -offset_m : offset_m) * points_per_m_;
    const auto i = static_cast<std::size_t>(at);
    if (i + 1 >= table_.size()) return 0;
    return table_[i] + (at - static_cast<double>(i)) * (table_[i + 1] - table_[i]);
  }

 private:
  double points_per_m_;
  std::vector<double> table_;
};

/// Least-squares fit of level = A m(x - x0) + c + d (x - x0) to the bins around x0.
struct RoofFit {
  double amplitude = 0;      ///< A
  double trough_dB = 0;      ///< c: the background under the leak
  double trend_dB_m = 0;     ///< d
  double reduction_dB2 = 0;  ///< weighted sum of squares that A m explains beyond c + d x; 0 when A <= 0
};

/// How well a fit explains the bins, their noise estimated from its own residuals.
struct FitQuality {
  double variance_dB2 = 0;  ///< of a frame, inflated by (1 + r) / (1 - r) for a residual correlation r;
                            ///< infinite when there are too few bins to tell
  double freedom = 0;       ///< effective number of independent residuals
  double z = 0;             ///< significance of the roof as a standard normal deviate
};

/// One channel of the bins from first to last (inclusive); empty ones are skipped. At most kMaxWeight frames
/// count per bin, so that a ball lying still does not drown the rest.
struct BinRange {
  static constexpr double kMaxWeight = 10;
  const SoundProfile* profile = nullptr;
  std::int64_t first = 0;
  std::int64_t last = 0;
  Channel channel = Channel::kRatio;
};

RoofFit FitRoof(const BinRange& bins, double x0_m, const Roof& roof);

/// z from t^2 = reduction / variance with nu = freedom by Wallace's z^2 = nu ln(1 + t^2 / nu) (J. Am. Stat.
/// Assoc. 54, 1121, 1959).
FitQuality CalcQuality(const BinRange& bins, double x0_m, const Roof& roof, const RoofFit& fit);

/// Probability that a standard normal deviate exceeds z.
double CalcNormalTail(double z);

}  // namespace piperun::estimator
