#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <vector>

#include "estimator/frame_locator.h"
#include "estimator/ricker_map.h"
#include "estimator/wall_classes.h"
#include "estimator/wavelet_frames.h"

namespace piperun::estimator::locators::wavelet_kurtosis {
namespace {

constexpr double kFrame_s = 0.2;  // four times the ring of a joint: a share of a frame, hence a kurtosis
constexpr double kFall_dB = 3;    // the finest wavelet is as wide as a roof that has fallen by this
constexpr double kLeastScale_m = 0.2, kMostScale_m = 25;
constexpr double kPlasticSlope_dB_m = 4;  // without a map
constexpr double kPriorLeaks_per_km = 1;

struct WaveletKurtosisParams : ParamsOf<WaveletKurtosisParams> {
  BandParams bands{.frame_s = kFrame_s};
  double impulsiveness_limit = 4;
  std::optional<double> scale_m;
  double false_alarms_per_km = 0.1;
  double min_height_dB = 1;

  void Visit(ParamVisitor& v) override {
    bands.Visit(v);
    v.Number({"impulsiveness_limit",
              "A frame is a knock when the kurtosis of one of its octaves exceeds that of Gaussian noise by "
              "this many standard deviations."},
             Range::Positive(), impulsiveness_limit);
    v.NumberOr({"scale_m",
                "Scale of the finest wavelet along the pipe; automatic: over which a leak falls by 3 dB."},
               Range::Positive(), "automatic", scale_m);
    v.Number({"false_alarms_per_km", "False alarms accepted per kilometre of quiet pipe."}, Range::Positive(),
             false_alarms_per_km);
    v.Number({"min_height_dB", "A leak must stand out of its background by this much."}, Range::NonNegative(),
             min_height_dB);
  }
};

double CalcScale_m(double slope_dB_m) {
  return std::clamp(kFall_dB / slope_dB_m, kLeastScale_m, kMostScale_m);
}

/// Wavelets twice: the record's own octaves (WaveletFrames) make the level of a band over a reference band in
/// frames whose kurtosis is that of Gaussian noise, which leaks are and knocks are not; Ricker's wavelet
/// along the pipe (RickerMap) finds where that level stands out, at three widths. A route through walls that
/// damp differently has a map for each class of them (ClassifyWalls), all of the same sound, each of which
/// reports what lies in its own pipes. confidence: as the matched filter's.
class WaveletKurtosis final : public PlacedFrameLocator<WaveletFrames> {
 public:
  WaveletKurtosis(const WaveletKurtosisParams& params, const EstimatorStart& start)
      : PlacedFrameLocator(WaveletFrames(params.bands)), params_(params) {
    const double middle_Hz = std::sqrt(params.bands.band_low_Hz * params.bands.band_high_Hz);
    const auto classes = start.map ? ClassifyWalls(*start.map, middle_Hz) : std::vector<WallClass>{};
    if (params.scale_m || classes.empty()) {
      AddMap(params.scale_m.value_or(CalcScale_m(kPlasticSlope_dB_m)), std::nullopt);
      return;
    }
    for (const WallClass& walls : classes) AddMap(CalcScale_m(walls.slope_dB_m), walls);
  }

 private:
  void AddMap(double scale_m, std::optional<WallClass> walls) {
    const RickerMap::Params params{scale_m, params_.false_alarms_per_km, params_.min_height_dB};
    const std::size_t index = maps_.size();
    maps_.push_back(std::make_unique<RickerMap>(params, [this, index, walls](const RickerPeak& peak) {
      if (!walls || walls->Holds(peak.posterior.mean_m)) Take(peak, *maps_[index]);
    }));
  }
  void Consume(const Located<WaveletFrame>& frame) override {
    if (frame.sound.impulsiveness > params_.impulsiveness_limit) return;
    const double band_dB = 10 * std::log10(frame.sound.power_Pa2);
    const double reference_dB = 10 * std::log10(frame.sound.reference_power_Pa2);
    for (const auto& map : maps_)
      map->Add(frame.ball, {band_dB - reference_dB, band_dB, reference_dB, band_dB});
  }
  void Complete() override {
    for (const auto& map : maps_) map->Complete();
  }

  void Take(const RickerPeak& peak, const RickerMap& map) {
    LeakEstimate leak;
    leak.t_cpa = peak.place.time;
    leak.chainage_m = peak.posterior.mean_m;
    leak.sigma_m = peak.posterior.sigma_m;
    leak.interval = {peak.posterior.low_m, peak.posterior.high_m};
    leak.p_W = peak.place.p_W;
    leak.confidence = kPriorLeaks_per_km / (kPriorLeaks_per_km + map.CalcFalseAlarms_per_km(peak.z));
    Report(leak);
  }

  WaveletKurtosisParams params_;
  std::vector<std::unique_ptr<RickerMap>> maps_;
};

std::unique_ptr<LeakLocator> Make(const Params& params, const EstimatorStart& start) {
  return std::make_unique<WaveletKurtosis>(dynamic_cast<const WaveletKurtosisParams&>(params), start);
}

}  // namespace

LocatorKind Kind() {
  return {"wavelet_kurtosis",
          "Octaves without impulsive frames, held against their surroundings by wavelets along the pipe.",
          MakeParams<WaveletKurtosisParams>, Make};
}

}  // namespace piperun::estimator::locators::wavelet_kurtosis
