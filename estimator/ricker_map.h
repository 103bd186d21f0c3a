#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "estimator/noise_scale.h"
#include "estimator/place_posterior.h"
#include "estimator/sound_profile.h"

namespace piperun::estimator {

/// A place where the map stands out.
struct RickerPeak {
  TrackPoint place;
  PlacePosterior posterior;
  double z = 0;
  double height_dB = 0;  ///< of a bump of the wavelet's own width
};

/// Wavelet map of a level along the pipe: the continuous transform with Ricker's wavelet
///
///     W(x, a) = sum over x' of psi((x' - x) / a) L(x'),   psi(u) = (1 - u^2) exp(-u^2 / 2)
///
/// at three scales a, each twice the one before. psi has neither mean nor slope, so a constant level and a
/// trend are nothing. Each scale is held against its own scatter s_a (NoiseScale) over `kSide` widest scales
/// on both sides, the peak itself left out, as a t of nu = 0.37 n degrees of freedom, n = stretch / 2a
/// independent values and 0.37 the efficiency of a median deviation; Wallace's formula (roof_fit.h) makes it
/// normal. Places whose
///
///     f(z) = sum over a of 1000 / (2 a) (1 - Phi(z))      false alarms per km
///
/// are accepted, that are the highest within four of their scales, and that have no deeper dip beside them
/// are reported. Posterior of the place: z^2 / 2 as its log likelihood.
class RickerMap {
 public:
  struct Params {
    double finest_m = 1;  ///< the smallest scale
    double false_alarms_per_km = 0.1;
    double min_height_dB = 1;
  };
  using Sink = std::function<void(const RickerPeak&)>;
  RickerMap(const Params& params, Sink sink);

  /// A level (channel kRatio) heard at a place.
  void Add(const TrackPoint& ball, const SoundLevels& levels_dB);
  void Complete();
  double CalcFalseAlarms_per_km(double z) const;

 private:
  static constexpr std::size_t kScales = 3;
  struct Scale {
    double a_m = 0;
    std::vector<double> psi;  // from the middle outwards
    double energy = 0;        // sum of psi^2 over both sides: height = W / energy
    NoiseScale scatter;
    std::vector<double> response_dB;  // ring
  };
  struct Point {
    std::int64_t bin = 0;
    double z = 0;
    std::size_t scale = 0;
  };

  void TransformUpTo(std::int64_t bin);
  void TestUpTo(std::int64_t bin);
  double Respond(const Scale& scale, std::int64_t bin);
  double CalcZ(Scale& scale, std::int64_t bin);
  Point Test(std::int64_t bin);
  void Follow(const Point& point);
  bool IsShoulder(const Point& peak) const;
  void ReportBest();
  std::size_t Slot(std::int64_t bin) const;

  Params params_;
  Sink sink_;
  double bin_m_;
  std::int64_t reach_bins_;  // of the widest wavelet
  std::int64_t side_bins_;   // that tell the scatter
  SoundProfile profile_;
  std::vector<Scale> scales_;
  std::optional<std::int64_t> next_transform_, next_test_;
  std::int64_t transformed_from_ = 0;
  std::optional<Point> best_;
  std::vector<double> log_likelihood_;  // scratch
};

}  // namespace piperun::estimator
