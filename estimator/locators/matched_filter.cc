#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <vector>

#include "estimator/drift_filter.h"
#include "estimator/frame_locator.h"
#include "estimator/impact_gate.h"
#include "estimator/leak_flow.h"
#include "estimator/roof_scan.h"
#include "estimator/wall_classes.h"

namespace piperun::estimator::locators::matched_filter {
namespace {

constexpr double kHampelLimit = 3.5, kHampelFloor_dB = 1.5;
constexpr double kPriorLeaks_per_km = 1;
constexpr double kMargin = 3;  // reaches around its pipes that a scan listens to

struct MatchedFilterParams : ParamsOf<MatchedFilterParams> {
  BandParams bands;
  double reference_weight = 1;
  std::optional<double> slope_dB_m;
  double false_alarms_per_km = 0.1;
  double min_height_dB = 1;
  LevelModel background;
  JetModel jet;

  void Visit(ParamVisitor& v) override {
    bands.Visit(v);
    v.Number({"reference_weight",
              "How much of the reference band's level is taken off the band's: 1 cancels a "
              "background that drifts in both alike, 0 uses the band alone."},
             Range::Between(0, 1), reference_weight);
    v.NumberOr({"slope_dB_m",
                "How steeply a leak's level falls along the pipe; automatic: from the map's wall, "
                "or plastic's range of slopes without a map."},
               Range::Positive(), "automatic", slope_dB_m);
    v.Number({"false_alarms_per_km", "False alarms accepted per kilometre of quiet pipe."}, Range::Positive(),
             false_alarms_per_km);
    v.Number({"min_height_dB", "A leak must stand out of its background by this much."}, Range::NonNegative(),
             min_height_dB);
    v.Number(
        {"common_drift_dB", "How far the background's level drifts along the way in all bands alike, rms."},
        Range::NonNegative(), background.common_drift_dB);
    v.Number({"own_drift_dB", "How far each band drifts for itself, rms."}, Range::Positive(),
             background.own_drift_dB);
    v.Number({"drift_length_m", "Distance over which the drift forgets itself."}, Range::Positive(),
             background.drift_length_m);
    v.Number({"leak_pressure_Pa", "Pressure assumed at a leak, inside minus outside, for telling its flow."},
             Range::Positive(), jet.pressure_Pa);
    v.Number({"relative_fluctuation",
              "Rms fluctuation of a leak's flow over the flow, assumed for telling its flow; levels in the "
              "literature differ by 15 dB."},
             Range::Positive(), jet.relative_fluctuation);
  }
};

/// The level of a band falls less steeply than its middle frequency does, because the lower end carries
/// further, and the reference band falls too: hence fractions of the nominal slope.
std::vector<double> SlopesAround(double nominal_dB_m) {
  return {0.35 * nominal_dB_m, 0.6 * nominal_dB_m, nominal_dB_m};
}

LevelModel MakeLevelModel(const MatchedFilterParams& params) {
  const BandParams& bands = params.bands;
  LevelModel model = params.background;
  model.band_scatter_dB = CalcLineFreeScatter_dB(bands.band_low_Hz, bands.band_high_Hz, bands.frame_s);
  model.reference_scatter_dB =
      CalcLineFreeScatter_dB(bands.reference_low_Hz, bands.reference_high_Hz, bands.frame_s);
  return model;
}

/// Matched filter in pipe coordinates: RoofScan on the level of a high band against that of a low one, frames
/// that were struck left out (ImpactGate, each band for itself). A route through walls that damp differently
/// is scanned once for each class of them, each with templates of its width, and each scan reports what lies
/// in its own pipes. confidence: lambda / (lambda + f), where f is the density of false alarms of at least
/// this z in quiet pipe and lambda, one per km, the density of leaks expected: the probability that this is
/// a leak.
class MatchedFilter final : public FrameLocator {
 public:
  MatchedFilter(const MatchedFilterParams& params, const EstimatorStart& start);

 private:
  struct Heard {
    TrackPoint ball;
    SoundLevels levels_dB{};
  };
  struct Listener {
    std::optional<WallClass> walls;  // nothing: everywhere
    std::unique_ptr<RoofScan> scan;
  };

  void Consume(const LocatedFrame& frame) override;
  void Complete() override {
    for (const Listener& listener : listeners_) listener.scan->Complete();
  }
  void AddListener(std::vector<double> slopes_dB_m, std::optional<WallClass> walls);
  void Take(const ScannedLeak& found, const std::optional<WallClass>& walls);
  void TellFlow(const ScannedLeak& found, LeakEstimate& leak) const;

  MatchedFilterParams params_;
  std::optional<RouteMap> map_;
  std::vector<Listener> listeners_;
  std::vector<double> reported_m_;
  ImpactGate<Heard> band_gate_{kHampelLimit, kHampelFloor_dB}, reference_gate_{kHampelLimit, kHampelFloor_dB};
};

MatchedFilter::MatchedFilter(const MatchedFilterParams& params, const EstimatorStart& start)
    : FrameLocator(BandFrames(params.bands)), params_(params), map_(start.map) {
  const double middle_Hz = std::sqrt(params.bands.band_low_Hz * params.bands.band_high_Hz);
  const auto classes = map_ ? ClassifyWalls(*map_, middle_Hz) : std::vector<WallClass>{};
  if (params.slope_dB_m) {
    AddListener(SlopesAround(*params.slope_dB_m), std::nullopt);
  } else if (classes.empty()) {
    AddListener({1, 2, 4, 8}, std::nullopt);  // plastic's
  } else {
    for (const WallClass& walls : classes) AddListener(SlopesAround(walls.slope_dB_m), walls);
  }
}

void MatchedFilter::AddListener(std::vector<double> slopes_dB_m, std::optional<WallClass> walls) {
  const ScanParams scan{std::move(slopes_dB_m), params_.false_alarms_per_km, params_.min_height_dB};
  const auto sink = [this, walls](const ScannedLeak& found) { Take(found, walls); };
  listeners_.push_back({walls, std::make_unique<RoofScan>(scan, MakeLevelModel(params_), sink)});
}

void MatchedFilter::Consume(const LocatedFrame& frame) {
  const double band_dB = 10 * std::log10(frame.sound.noise_Pa2);
  const double reference_dB = 10 * std::log10(frame.sound.reference_noise_Pa2);
  const double power_dB = 10 * std::log10(frame.sound.power_Pa2);
  const Heard heard{frame.ball,
                    {band_dB - params_.reference_weight * reference_dB, band_dB, reference_dB, power_dB}};
  const auto unstruck = band_gate_.Step(heard, band_dB);
  if (!unstruck) return;
  const auto passed = reference_gate_.Step(*unstruck, unstruck->levels_dB[2]);
  if (!passed) return;
  for (const Listener& listener : listeners_) {
    if (listener.walls && !listener.walls->Holds(passed->ball.chainage_m, kMargin * listener.scan->reach_m()))
      continue;
    listener.scan->Add(passed->ball, passed->levels_dB);
  }
}

void MatchedFilter::Take(const ScannedLeak& found, const std::optional<WallClass>& walls) {
  const double chainage_m = found.posterior.mean_m;
  if (walls && !walls->Holds(chainage_m)) return;
  const auto same = [&](double reported_m) { return std::abs(reported_m - chainage_m) < found.apart_m; };
  // where walls change, the neighbouring pipe's scan may have told of it
  if (std::any_of(reported_m_.begin(), reported_m_.end(), same)) return;
  reported_m_.push_back(chainage_m);
  LeakEstimate leak;
  leak.t_cpa = found.place.time;
  leak.chainage_m = chainage_m;
  leak.sigma_m = found.posterior.sigma_m;
  leak.interval = {found.posterior.low_m, found.posterior.high_m};
  leak.p_W = found.place.p_W;
  leak.confidence = kPriorLeaks_per_km / (kPriorLeaks_per_km + found.false_alarms_per_km);
  TellFlow(found, leak);
  Report(leak);
}

void MatchedFilter::TellFlow(const ScannedLeak& found, LeakEstimate& leak) const {
  if (!map_ || !found.level) return;
  const Pipe& pipe = map_->network.pipe(map_->route.Locate(leak.chainage_m).pipe);
  const auto flow = CalcLeakFlow(params_.jet, pipe, params_.bands.band_low_Hz, params_.bands.band_high_Hz,
                                 found.level->pressure_Pa2, found.level->sigma_dB);
  if (!flow) return;
  leak.flow_m3_s = flow->flow_m3_s;
  leak.flow_sigma_dB = flow->sigma_dB;
}

std::unique_ptr<LeakLocator> Make(const Params& params, const EstimatorStart& start) {
  return std::make_unique<MatchedFilter>(dynamic_cast<const MatchedFilterParams&>(params), start);
}

}  // namespace

LocatorKind Kind() {
  return {
      "matched_filter",
      "Fits the two-sided exponential of a leak's sound along the pipe to a ratio of bands; rejects impacts.",
      MakeParams<MatchedFilterParams>, Make};
}

}  // namespace piperun::estimator::locators::matched_filter
