#include <algorithm>
#include <cmath>
#include <optional>

#include "estimator/frame_locator.h"
#include "estimator/pipe_loss.h"
#include "estimator/ricker_map.h"
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

double ChooseScale_m(const WaveletKurtosisParams& params, const EstimatorStart& start) {
  if (params.scale_m) return *params.scale_m;
  double slope_dB_m = kPlasticSlope_dB_m;
  if (start.map) {
    const Pipe& pipe = start.map->network.pipe(start.map->route.pieces().front().pipe);
    slope_dB_m = CalcAttenuation_dB_m(pipe, std::sqrt(params.bands.band_low_Hz * params.bands.band_high_Hz));
  }
  return std::clamp(kFall_dB / slope_dB_m, kLeastScale_m, kMostScale_m);
}

/// Wavelets twice: the record's own octaves (WaveletFrames) make the level of a band over a reference band in
/// frames whose kurtosis is that of Gaussian noise, which leaks are and knocks are not; Ricker's wavelet
/// along the pipe (RickerMap) finds where that level stands out, at three widths. confidence: as the matched
/// filter's.
class WaveletKurtosis final : public PlacedFrameLocator<WaveletFrames> {
 public:
  WaveletKurtosis(const WaveletKurtosisParams& params, const EstimatorStart& start)
      : PlacedFrameLocator(WaveletFrames(params.bands)),
        limit_(params.impulsiveness_limit),
        map_({ChooseScale_m(params, start), params.false_alarms_per_km, params.min_height_dB},
             [this](const RickerPeak& peak) { Take(peak); }) {}

 private:
  void Consume(const Located<WaveletFrame>& frame) override {
    if (frame.sound.impulsiveness > limit_) return;
    const double band_dB = 10 * std::log10(frame.sound.power_Pa2);
    const double reference_dB = 10 * std::log10(frame.sound.reference_power_Pa2);
    map_.Add(frame.ball, {band_dB - reference_dB, band_dB, reference_dB, band_dB});
  }
  void Complete() override { map_.Complete(); }

  void Take(const RickerPeak& peak) {
    LeakEstimate leak;
    leak.t_cpa = peak.place.time;
    leak.chainage_m = peak.posterior.mean_m;
    leak.sigma_m = peak.posterior.sigma_m;
    leak.interval = {peak.posterior.low_m, peak.posterior.high_m};
    leak.p_W = peak.place.p_W;
    leak.confidence = kPriorLeaks_per_km / (kPriorLeaks_per_km + map_.CalcFalseAlarms_per_km(peak.z));
    Report(leak);
  }

  double limit_;
  RickerMap map_;
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
