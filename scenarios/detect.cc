#include "scenarios/detect.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>

#include "acoustics/sound_file.h"
#include "base/check.h"
#include "base/number.h"
#include "estimator/band_frames.h"
#include "estimator/leak_locator.h"
#include "scenarios/materials.h"
#include "base/nearest_name.h"
#include "scenarios/yaml_document.h"

namespace piperun::scenarios {
namespace {

constexpr std::size_t kBlock = 1024;
constexpr double kCounts = 8388608;  // per full scale: 24 bits
constexpr double kMostClipped = 0.01;
constexpr double kNav_s = 0.05;
constexpr std::size_t kMostLevels = 2000;

struct TrackRow {
  double time_s = 0, chainage_m = 0;
};

TrackRow ParseTrackRow(const std::string& line, const std::string& where) {
  const std::size_t comma = line.find(',');
  const auto time_s = ParseNumber(std::string_view(line).substr(0, comma));
  const auto chainage_m =
      comma == std::string::npos ? std::nullopt : ParseNumber(std::string_view(line).substr(comma + 1));
  if (!time_s || !chainage_m)
    throw InputError("'" + line + "' is not two numbers, time_s,chainage_m", "", where);
  return {*time_s, *chainage_m};
}

std::vector<TrackRow> LoadTrack(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::string line;
  if (!file || !std::getline(file, line)) throw InputError("cannot be read", "", path.string());
  if (line != "time_s,chainage_m")
    throw InputError("the header is '" + line + "'; it must be time_s,chainage_m", "", path.string() + ":1");
  std::vector<TrackRow> rows;
  for (int number = 2; std::getline(file, line); ++number) {
    const std::string where = path.string() + ":" + std::to_string(number);
    rows.push_back(ParseTrackRow(line, where));
    if (rows.size() > 1 && rows.back().time_s <= rows[rows.size() - 2].time_s)
      throw InputError("time " + FormatNumber(rows.back().time_s) + " s does not rise", "time_s", where);
  }
  if (rows.size() < 2) throw InputError("holds fewer than two rows", "", path.string());
  return rows;
}

/// Where the ball was, from a track or at constant speed.
class Way {
 public:
  explicit Way(const DetectOptions& options) {
    if (!options.track.empty()) rows_ = LoadTrack(options.track);
    if (options.pipe) {
      start_m_ = options.pipe->start_chainage_m;
      speed_m_s_ = options.pipe->speed_m_s;
    }
  }
  /// Throws InputError unless the track covers the record.
  void RequireCovers(double duration_s, const std::filesystem::path& track) const {
    if (rows_.empty() || (rows_.front().time_s <= 0 && rows_.back().time_s >= duration_s)) return;
    throw InputError("covers " + FormatNumber(rows_.front().time_s) + " to " +
                         FormatNumber(rows_.back().time_s) + " s; the record lasts from 0 to " +
                         FormatNumber(duration_s) + " s",
                     "time_s", track.string());
  }
  double Chainage_m(double time_s) const {
    if (rows_.empty()) return start_m_ + speed_m_s_ * time_s;
    const auto later = std::partition_point(rows_.begin() + 1, rows_.end() - 1,
                                            [&](const TrackRow& row) { return row.time_s < time_s; });
    const TrackRow &a = *(later - 1), &b = *later;
    return a.chainage_m + (time_s - a.time_s) / (b.time_s - a.time_s) * (b.chainage_m - a.chainage_m);
  }

 private:
  std::vector<TrackRow> rows_;
  double start_m_ = 0, speed_m_s_ = 0.5;
};

estimator::EstimatorStart MakeStart(const DetectPipe& pipe, double length_m) {
  PipeSpec spec;
  spec.id = "P1";
  spec.from = "A";
  spec.to = "B";
  spec.diameter_m = pipe.diameter_m;
  spec.wall_thickness_m = pipe.wall_thickness_m;
  spec.material = {pipe.material,
                   pipe.wall.young_modulus_Pa,
                   pipe.wall.loss_factor,
                   pipe.wall.poisson_ratio,
                   pipe.wall.density_kg_m3,
                   pipe.wall.roughness_m,
                   pipe.wall.relative_permeability};
  Network network({{"A", {0, 0, 0}}, {"B", {length_m, 0, 0}}}, {spec});
  Route route(network, {{0, false}});
  estimator::EstimatorStart start;
  start.map = estimator::RouteMap{std::move(network), std::move(route)};
  return start;
}

void RequireLocator(const std::string& name) {
  std::vector<std::string> known;
  std::string all;
  for (const estimator::LocatorKind& kind : estimator::LocatorKinds()) {
    if (kind.name == name) return;
    known.emplace_back(kind.name);
    all += (all.empty() ? "" : ", ") + known.back();
  }
  std::string problem = "there is no locator '" + name + "'; known: " + all;
  if (const auto near = FindNearestName(name, known)) problem += "; did you mean '" + *near + "'?";
  throw InputError(problem, "--locator");
}

/// The locator asked for with default parameters, or else the pipe file's, or else the matched filter.
estimator::LocatorChoice ChooseLocator(const DetectOptions& options) {
  if (options.locator.empty()) return options.pipe ? options.pipe->locator : estimator::LocatorChoice();
  RequireLocator(options.locator);
  return estimator::LocatorChoice(options.locator);
}

/// Samples as counts of a 24-bit converter; counts what is wrong with them.
class Intake {
 public:
  explicit Intake(std::string where) : where_(std::move(where)) {}

  void Take(std::span<const double> samples, std::vector<std::int32_t>& counts) {
    counts.clear();
    for (const double sample : samples) {
      if (!std::isfinite(sample) || std::abs(sample) > 128) {
        throw InputError("sample " + std::to_string(samples_) + " is not a finite part of full scale", "",
                         where_);
      }
      ++samples_;
      full_scale_ += std::abs(sample) >= 1 - 1.0 / 32768 ? 1 : 0;
      counts.push_back(static_cast<std::int32_t>(std::lrint(sample * kCounts)));
      silent_ = silent_ && counts.back() == 0;
    }
  }
  void RequireSound() const {
    if (silent_) throw InputError("is silent: all samples are zero", "", where_);
    if (static_cast<double>(full_scale_) > kMostClipped * static_cast<double>(samples_)) {
      throw InputError(std::to_string(full_scale_) + " of " + std::to_string(samples_) +
                           " samples are at full scale (at most 1 % are allowed): the record is clipped",
                       "", where_);
    }
  }
  std::int64_t full_scale() const { return full_scale_; }

 private:
  std::string where_;
  std::int64_t samples_ = 0, full_scale_ = 0;
  bool silent_ = true;
};

/// Levels of the record, thinned to what a plot shows.
class LevelLog {
 public:
  LevelLog(const Way& way, double duration_s)
      : way_(way), stretch_s_(std::max(0.1, duration_s / static_cast<double>(kMostLevels))) {}
  void Ingest(const AudioBlock& block) {
    frames_.Ingest(block, [this](const estimator::BandFrame& frame) { Add(frame); });
  }
  std::vector<DetectedLevel> Take() {
    Cut();
    return std::move(levels_);
  }

 private:
  void Add(const estimator::BandFrame& frame) {
    if (count_ == 0) begin_s_ = Seconds(frame.time);
    band_Pa2_ += frame.noise_Pa2;
    reference_Pa2_ += frame.reference_noise_Pa2;
    ++count_;
    if (Seconds(frame.time) - begin_s_ >= stretch_s_) Cut();
  }
  void Cut() {
    if (count_ > 0 && band_Pa2_ > 0 && reference_Pa2_ > 0) {
      const double time_s = begin_s_ + 0.5 * stretch_s_;
      levels_.push_back({time_s, way_.Chainage_m(time_s), 10 * std::log10(band_Pa2_ / count_) + 120,
                         10 * std::log10(band_Pa2_ / reference_Pa2_)});
    }
    band_Pa2_ = reference_Pa2_ = 0;
    count_ = 0;
  }

  const Way& way_;
  double stretch_s_, begin_s_ = 0, band_Pa2_ = 0, reference_Pa2_ = 0;
  int count_ = 0;
  estimator::BandFrames frames_{estimator::BandParams{}};
  std::vector<DetectedLevel> levels_;
};

/// Tells the locator where the ball was, up to a time.
class Navigator {
 public:
  explicit Navigator(const Way& way) : way_(way) {}
  void TellUpTo(double time_s, estimator::LeakLocator& locator) {
    for (; kNav_s * static_cast<double>(next_) <= time_s + kNav_s; ++next_) {
      const double t_s = kNav_s * static_cast<double>(next_);
      estimator::NavState nav;
      nav.stamp = RobotTime(FromSeconds(t_s));
      nav.valid = true;
      nav.chainage_m = way_.Chainage_m(t_s);
      nav.p_W = {nav.chainage_m, 0, 0};
      locator.IngestNav(nav);
    }
  }

 private:
  const Way& way_;
  std::int64_t next_ = 0;
};

}  // namespace

void DetectPipe::Visit(ParamVisitor& v) {
  const std::vector<std::string_view> names = MaterialNames();
  v.Choice({"material", "Wall material, a name from the material library."}, names, material);
  wall = FindWall(material, wall);
  v.Struct({"wall", "Properties of the wall, where they differ from the material's."}, wall);
  v.Number({"diameter_m", "Inner diameter (bore).", true}, {.min = 0.01, .max = 10}, diameter_m);
  v.Number({"wall_thickness_m", "Wall thickness.", true}, {.min = 1e-4, .max = 1}, wall_thickness_m);
  v.NumberOr({"length_m", "Length of the route."}, {.min = 1, .max = 1e6}, "as_recorded", length_m);
  v.Number({"speed_m_s", "Speed of the ball, constant, when no track is given."}, Range::Positive(),
           speed_m_s);
  v.Number({"start_chainage_m", "Where the record begins, when no track is given."}, Range::Any(),
           start_chainage_m);
  v.Number({"full_scale_Pa", "Pressure of the largest sample the file can hold."}, Range::Positive(),
           full_scale_Pa);
  v.Struct({"locator", "How leaks are told, where the command line does not say."}, locator);
}

DetectPipe LoadDetectPipe(const std::filesystem::path& path) {
  DetectPipe pipe;
  YamlDocument::FromFile(path.string()).Read([&](ParamVisitor& v) { pipe.Visit(v); });
  return pipe;
}

Detections Detect(const DetectOptions& options) {
  acoustics::SoundFile file(options.audio);
  const estimator::LocatorChoice choice = ChooseLocator(options);
  if (choice.none()) throw InputError("'none' finds nothing; name a locator", "locator.kind");
  Detections result;
  result.audio = options.audio.filename().string();
  result.locator = choice.kind();
  result.rate_Hz = file.rate_Hz();
  result.duration_s = static_cast<double>(file.frames()) / file.rate_Hz();
  result.placed = options.pipe || !options.track.empty();
  const Way way(options);
  way.RequireCovers(result.duration_s, options.track);
  estimator::EstimatorStart start;
  if (options.pipe) {
    const double recorded_m = std::max(1.0, way.Chainage_m(result.duration_s));
    start = MakeStart(*options.pipe, options.pipe->length_m.value_or(recorded_m));
  }
  const auto locator = choice.Make(start);
  const double scale_Pa = (options.pipe ? options.pipe->full_scale_Pa : 1) / kCounts;
  Intake intake(options.audio.string());
  LevelLog levels(way, result.duration_s);
  Navigator navigator(way);
  std::vector<double> samples(kBlock);
  std::vector<std::int32_t> counts;
  counts.reserve(kBlock);
  const Rate rate(result.rate_Hz);
  std::int64_t read = 0;
  while (const std::size_t n = file.Read(samples)) {
    intake.Take(std::span(samples).first(n), counts);
    read += static_cast<std::int64_t>(n);
    const AudioBlock block{RobotTime(SampleOffset(read - 1, rate)), result.rate_Hz, scale_Pa, counts};
    navigator.TellUpTo(Seconds(block.stamp), *locator);
    locator->IngestAudio(block);
    levels.Ingest(block);
  }
  intake.RequireSound();
  locator->Finish();
  result.full_scale_samples = intake.full_scale();
  result.leaks = locator->leaks();
  result.levels = levels.Take();
  return result;
}

std::string WriteDetectionsJson(const Detections& detections) {
  using Json = nlohmann::ordered_json;
  Json leaks = Json::array();
  for (const estimator::LeakEstimate& leak : detections.leaks) {
    leaks.push_back(
        {{"time_s", Seconds(leak.t_cpa)},
         {"chainage_m", detections.placed ? Json(leak.chainage_m) : Json()},
         {"sigma_m", detections.placed ? Json(leak.sigma_m) : Json()},
         {"interval_m",
          detections.placed ? Json(Json::array({leak.interval.low_m, leak.interval.high_m})) : Json()},
         {"confidence", leak.confidence},
         {"flow_m3_s", leak.flow_m3_s ? Json(*leak.flow_m3_s) : Json()},
         {"flow_sigma_dB", leak.flow_m3_s ? Json(leak.flow_sigma_dB) : Json()}});
  }
  const Json json{{"schema", "piperun.detect/1"},
                  {"audio", detections.audio},
                  {"locator", detections.locator},
                  {"rate_Hz", detections.rate_Hz},
                  {"duration_s", detections.duration_s},
                  {"full_scale_samples", detections.full_scale_samples},
                  {"detections", leaks}};
  return json.dump(2) + "\n";
}

std::string WriteDetectionsCsv(const Detections& detections) {
  std::string csv = "time_s,chainage_m,sigma_m,confidence,flow_m3_s,flow_sigma_dB\n";
  for (const estimator::LeakEstimate& leak : detections.leaks) {
    const std::string place =
        detections.placed ? FormatNumber(leak.chainage_m) + "," + FormatNumber(leak.sigma_m) : ",";
    csv += FormatNumber(Seconds(leak.t_cpa)) + "," + place + "," + FormatNumber(leak.confidence) + ",";
    csv += leak.flow_m3_s ? FormatNumber(*leak.flow_m3_s) + "," + FormatNumber(leak.flow_sigma_dB) : ",";
    csv += "\n";
  }
  return csv;
}

}  // namespace piperun::scenarios
