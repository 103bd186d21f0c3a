#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "estimator/frame_locator.h"
#include "estimator/impact_gate.h"
#include "estimator/roof_fit.h"
#include "estimator/sound_profile.h"
#include "estimator/wall_classes.h"

namespace piperun::estimator::locators::cfar_ratio {
namespace {

constexpr double kFall_dB = 3;  // a cell is as wide as a roof that has fallen by this on both sides
constexpr std::int64_t kBinsPerCell = 5;
constexpr double kMinWidth_m = 0.2, kMaxWidth_m = 50;
constexpr double kHampelLimit = 3.5, kHampelFloor_dB = 1.5;
constexpr double kPriorLeaks_per_km = 1;
constexpr double kPlasticSlope_dB_m = 4;  // without a map

struct CfarRatioParams : ParamsOf<CfarRatioParams> {
  BandParams bands;
  std::optional<double> width_m;
  std::int64_t guard_cells = 3;
  std::int64_t reference_cells = 8;
  std::string average = "order";
  double false_alarms_per_km = 0.1;
  double min_height_dB = 1;

  void Visit(ParamVisitor& v) override {
    bands.Visit(v);
    v.NumberOr({"width_m", "Width of a cell: of a leak's peak; automatic: over which it falls by 3 dB."},
               Range::Positive(), "automatic", width_m);
    v.Integer({"guard_cells", "Cells left out on each side of the one under test: more than 3 leak widths."},
              1, 100, guard_cells);
    v.Integer({"reference_cells", "Cells behind them on each side, that tell the background."}, 4, 200,
              reference_cells);
    v.Choice({"average", "Background by the cells' mean (cell averaging) or median (order statistic)."},
             std::array<std::string_view, 2>{"cells", "order"}, average);
    v.Number({"false_alarms_per_km", "False alarms accepted per kilometre of quiet pipe."}, Range::Positive(),
             false_alarms_per_km);
    v.Number({"min_height_dB", "A leak must stand out of its background by this much."}, Range::NonNegative(),
             min_height_dB);
  }
};

double CalcWidth_m(double slope_dB_m) {
  return std::clamp(2 * kFall_dB / slope_dB_m, kMinWidth_m, kMaxWidth_m);
}

/// A place that stands out of its surroundings.
struct Peak {
  std::int64_t bin = 0;
  double z = 0;
  double height_dB = 0;
  double scatter_dB = 0;  ///< of the reference cells
};

/// Constant-false-alarm-rate detector on the level of a band over a reference band, in pipe coordinates. The
/// cell under test, one leak's width, is held against reference cells on both sides behind guard cells:
///
///     t = (L - centre) / (s sqrt(1 + 1/n)),   centre, s: mean and standard deviation of the n cells (cell
///     averaging; Finn & Johnson, RCA Review 29, 414, 1968), or median and 1.4826 median absolute deviation
///     (order statistic; Rohling, IEEE Trans. AES-19, 608, 1983)
///
/// taken to a normal deviate by Wallace's formula with n - 1 degrees of freedom. The place is the centroid of
/// the excess over the background within the cell; its sigma is that of the cell's width over the ratio of
/// height to scatter, and the track's. Both sides must have been heard.
class CfarScan {
 public:
  using Sink = std::function<void(const LeakEstimate&)>;
  CfarScan(const CfarRatioParams& params, double width_m, Sink sink)
      : params_(params),
        sink_(std::move(sink)),
        width_m_(width_m),
        side_bins_(kBinsPerCell * (params.guard_cells + params.reference_cells) + kBinsPerCell),
        profile_(width_m_ / kBinsPerCell, 3 * static_cast<double>(side_bins_) * width_m_ / kBinsPerCell) {
    cells_.reserve(2 * static_cast<std::size_t>(params.reference_cells));
    deviations_.reserve(cells_.capacity());
  }
  void Add(const TrackPoint& ball, const SoundLevels& levels_dB) {
    profile_.Add(ball, levels_dB);
    TestUpTo(profile_.last() - side_bins_ - 1);
  }
  void Complete() {
    if (profile_.empty()) return;
    TestUpTo(profile_.last() - side_bins_);
    if (best_) ReportPeak(*best_);
    best_.reset();
  }

 private:
  void TestUpTo(std::int64_t bin) {
    if (!next_) next_ = profile_.first() + side_bins_;
    for (; *next_ <= bin; ++*next_) Follow(Test(*next_));
  }
  /// Keeps the highest of a run of peaks and reports it when it lies a guard behind.
  void Follow(const Peak& peak) {
    const std::int64_t guard = kBinsPerCell * params_.guard_cells;
    if (best_ && peak.bin - best_->bin > guard) {
      ReportPeak(*best_);
      best_.reset();
    }
    if (FalseAlarms_per_km(peak.z) > params_.false_alarms_per_km || peak.height_dB < params_.min_height_dB)
      return;
    if (!best_ || peak.z > best_->z) best_ = peak;
  }
  /// Mean level of the cell around a bin; nothing when it was not heard.
  std::optional<double> CellLevel_dB(std::int64_t bin) const {
    double sum = 0, weight = 0;
    for (std::int64_t i = bin - kBinsPerCell / 2; i <= bin + kBinsPerCell / 2; ++i) {
      if (i < profile_.first() || i > profile_.last()) continue;
      const ProfileBin& heard = profile_.At(i);
      sum += heard.weight * heard.levels_dB[0];
      weight += heard.weight;
    }
    return weight > 0 ? std::optional(sum / weight) : std::nullopt;
  }
  void GatherReference(std::int64_t bin) {
    cells_.clear();
    for (std::int64_t k = 1; k <= params_.reference_cells; ++k) {
      for (const std::int64_t side : {-1, 1}) {
        if (const auto level_dB = CellLevel_dB(bin + side * kBinsPerCell * (params_.guard_cells + k)))
          cells_.push_back(*level_dB);
      }
    }
  }
  static double Median(std::vector<double>& values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
  }
  std::pair<double, double> CentreAndScatter_dB() {
    if (params_.average == "order") {
      const double centre = Median(cells_);
      deviations_.clear();
      for (const double cell : cells_) deviations_.push_back(std::abs(cell - centre));
      return {centre, 1.4826 * Median(deviations_)};
    }
    double sum = 0, squares = 0;
    for (const double cell : cells_) sum += cell;
    const double n = static_cast<double>(cells_.size()), mean = sum / n;
    for (const double cell : cells_) squares += (cell - mean) * (cell - mean);
    return {mean, std::sqrt(squares / (n - 1))};
  }
  Peak Test(std::int64_t bin) {
    Peak peak{bin, 0, 0, 0};
    const auto level_dB = CellLevel_dB(bin);
    GatherReference(bin);
    if (!level_dB || cells_.size() < 4) return peak;
    const double n = static_cast<double>(cells_.size());
    const auto [centre_dB, scatter_dB] = CentreAndScatter_dB();
    peak.height_dB = *level_dB - centre_dB;
    peak.scatter_dB = scatter_dB;
    if (!(peak.height_dB > 0) || !(scatter_dB > 0)) return peak;
    const double t2 = peak.height_dB * peak.height_dB / (scatter_dB * scatter_dB * (1 + 1 / n));
    peak.z = std::sqrt((n - 1) * std::log1p(t2 / (n - 1)));
    return peak;
  }
  /// Independent cells per kilometre times the chance of one.
  double FalseAlarms_per_km(double z) const { return 1000 / width_m_ * CalcNormalTail(z); }

  void ReportPeak(const Peak& peak) {
    const double floor_dB = *CellLevel_dB(peak.bin) - peak.height_dB;
    double moment = 0, mass = 0;
    for (std::int64_t i = peak.bin - kBinsPerCell; i <= peak.bin + kBinsPerCell; ++i) {
      const ProfileBin& heard = profile_.At(i);
      const double excess = heard.weight > 0 ? std::max(0.0, heard.levels_dB[0] - floor_dB) : 0;
      moment += excess * heard.chainage_m;
      mass += excess;
    }
    if (!(mass > 0)) return;
    const TrackPoint place = profile_.Interpolate(moment / mass);
    LeakEstimate leak;
    leak.t_cpa = place.time;
    leak.chainage_m = moment / mass;
    leak.sigma_m = std::hypot(width_m_ * peak.scatter_dB / peak.height_dB, place.chainage_sd_m);
    leak.interval = CalcNormalInterval(leak.chainage_m, leak.sigma_m);
    leak.p_W = place.p_W;
    leak.confidence = kPriorLeaks_per_km / (kPriorLeaks_per_km + FalseAlarms_per_km(peak.z));
    sink_(leak);
  }

  CfarRatioParams params_;
  Sink sink_;
  double width_m_;
  std::int64_t side_bins_;
  SoundProfile profile_;
  std::vector<double> cells_, deviations_;  // scratch
  std::optional<std::int64_t> next_;
  std::optional<Peak> best_;
};

/// A scan of all frames that were not struck; on a route through walls that damp differently one for each
/// class of them (ClassifyWalls), with cells of its width, which reports what lies in its own pipes.
class CfarRatio final : public FrameLocator {
 public:
  CfarRatio(const CfarRatioParams& params, const EstimatorStart& start)
      : FrameLocator(BandFrames(params.bands)) {
    const double middle_Hz = std::sqrt(params.bands.band_low_Hz * params.bands.band_high_Hz);
    const auto classes = start.map ? ClassifyWalls(*start.map, middle_Hz) : std::vector<WallClass>{};
    if (params.width_m || classes.empty()) {
      AddScan(params, params.width_m.value_or(CalcWidth_m(kPlasticSlope_dB_m)), std::nullopt);
      return;
    }
    for (const WallClass& walls : classes) AddScan(params, CalcWidth_m(walls.slope_dB_m), walls);
  }

 private:
  struct Heard {
    TrackPoint ball;
    SoundLevels levels_dB{};
  };

  void AddScan(const CfarRatioParams& params, double width_m, std::optional<WallClass> walls) {
    scans_.push_back(std::make_unique<CfarScan>(params, width_m, [this, walls](const LeakEstimate& leak) {
      if (!walls || walls->Holds(leak.chainage_m)) Report(leak);
    }));
  }
  void Consume(const LocatedFrame& frame) override {
    const double band_dB = 10 * std::log10(frame.sound.noise_Pa2);
    const double ratio_dB = band_dB - 10 * std::log10(frame.sound.reference_noise_Pa2);
    const auto passed = gate_.Step({frame.ball, {ratio_dB, band_dB, band_dB - ratio_dB, band_dB}}, band_dB);
    if (!passed) return;
    for (const auto& scan : scans_) scan->Add(passed->ball, passed->levels_dB);
  }
  void Complete() override {
    for (const auto& scan : scans_) scan->Complete();
  }

  std::vector<std::unique_ptr<CfarScan>> scans_;
  ImpactGate<Heard> gate_{kHampelLimit, kHampelFloor_dB};
};

std::unique_ptr<LeakLocator> Make(const Params& params, const EstimatorStart& start) {
  return std::make_unique<CfarRatio>(dynamic_cast<const CfarRatioParams&>(params), start);
}

}  // namespace

LocatorKind Kind() {
  return {"cfar_ratio",
          "Ratio of two bands held against its surroundings along the pipe at a constant false-alarm rate.",
          MakeParams<CfarRatioParams>, Make};
}

}  // namespace piperun::estimator::locators::cfar_ratio
