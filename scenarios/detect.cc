#include "scenarios/detect.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <memory>

#include "acoustics/sound_file.h"
#include "base/check.h"
#include "base/nearest_name.h"
#include "base/number.h"
#include "estimator/band_frames.h"
#include "estimator/leak_locator.h"
#include "scenarios/materials.h"
#include "scenarios/network_params.h"
#include "scenarios/yaml_document.h"

namespace piperun::scenarios {
namespace {

constexpr std::size_t kBlock = 1024;
constexpr double kCounts = 8388608;  // per full scale: 24 bits
constexpr double kMostClipped = 0.01;
constexpr double kNav_s = 0.05;
constexpr double kBendRadius_diameters = 1.5;  // of the drawn line's corners
constexpr std::size_t kMostLevels = 2000;

struct TrackRow {
  double time_s = 0, chainage_m = 0, sd_m = 0;
};

constexpr const char* kTrackHeader = "time_s,chainage_m";
constexpr const char* kTrackSdHeader = "time_s,chainage_m,chainage_sd_m";

TrackRow ParseTrackRow(const std::string& line, bool with_sd, const std::string& where) {
  std::vector<double> fields;
  for (std::size_t begin = 0; begin <= line.size();) {
    const std::size_t comma = std::min(line.find(',', begin), line.size());
    const auto field = ParseNumber(std::string_view(line).substr(begin, comma - begin));
    if (!field) break;
    fields.push_back(*field);
    begin = comma + 1;
  }
  const std::string header = with_sd ? kTrackSdHeader : kTrackHeader;
  const auto columns = static_cast<std::size_t>(std::count(header.begin(), header.end(), ',')) + 1;
  const auto commas = static_cast<std::size_t>(std::count(line.begin(), line.end(), ','));
  if (fields.size() != columns || commas + 1 != columns)
    throw InputError("'" + line + "' is not a row of numbers " + header, "", where);
  if (with_sd && fields[2] < 0)
    throw InputError("a standard deviation of " + FormatNumber(fields[2]) + " m; it must be >= 0",
                     "chainage_sd_m", where);
  return {fields[0], fields[1], with_sd ? fields[2] : 0};
}

std::vector<TrackRow> LoadTrack(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::string line;
  if (!file || !std::getline(file, line)) throw InputError("cannot be read", "", path.string());
  const bool with_sd = line == kTrackSdHeader;
  if (line != kTrackHeader && !with_sd)
    throw InputError("the header is '" + line + "'; it must be " + kTrackHeader + " or " + kTrackSdHeader, "",
                     path.string() + ":1");
  std::vector<TrackRow> rows;
  for (int number = 2; std::getline(file, line); ++number) {
    const std::string where = path.string() + ":" + std::to_string(number);
    rows.push_back(ParseTrackRow(line, with_sd, where));
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
    if (options.pipe) {
      start_m_ = options.pipe->start_chainage_m;
      speed_m_s_ = options.pipe->speed_m_s;
      speed_sd_m_s_ = options.pipe->speed_sd_m_s;
    }
    if (options.speed_sd_m_s) speed_sd_m_s_ = *options.speed_sd_m_s;
    if (!(speed_sd_m_s_ >= 0 && std::isfinite(speed_sd_m_s_)))
      throw InputError(FormatNumber(speed_sd_m_s_) + " m/s is not allowed; it must be >= 0", "--speed-sd");
    if (options.track.empty()) return;
    if (options.speed_sd_m_s)
      throw InputError("a track brings its own uncertainty: a third column, chainage_sd_m", "--speed-sd");
    rows_ = LoadTrack(options.track);
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
    return rows_.empty() ? start_m_ + speed_m_s_ * time_s : Interpolate(time_s, &TrackRow::chainage_m);
  }
  double Sd_m(double time_s) const {
    return rows_.empty() ? speed_sd_m_s_ * time_s : Interpolate(time_s, &TrackRow::sd_m);
  }
  /// What an interval holds.
  std::string DescribeErrors() const {
    const std::string sound = "the sound's place on the way";
    if (rows_.empty()) {
      return speed_sd_m_s_ > 0 ? sound + ", and a constant speed of " + FormatNumber(speed_m_s_) +
                                     " m/s known to " + FormatNumber(speed_sd_m_s_) + " m/s"
                               : sound + " only: the constant speed of " + FormatNumber(speed_m_s_) +
                                     " m/s is taken as exact (--speed-sd)";
    }
    const bool known = std::any_of(rows_.begin(), rows_.end(), [](const TrackRow& r) { return r.sd_m > 0; });
    return known ? sound + ", and the track's own uncertainty"
                 : sound +
                       " only: the track is taken as exact (a third column, chainage_sd_m, says how "
                       "uncertain it is)";
  }

 private:
  double Interpolate(double time_s, double TrackRow::*field) const {
    const auto later = std::partition_point(rows_.begin() + 1, rows_.end() - 1,
                                            [&](const TrackRow& row) { return row.time_s < time_s; });
    const TrackRow &a = *(later - 1), &b = *later;
    return a.*field + (time_s - a.time_s) / (b.time_s - a.time_s) * (b.*field - a.*field);
  }

  std::vector<TrackRow> rows_;
  double start_m_ = 0, speed_m_s_ = 0.5, speed_sd_m_s_ = 0;
};

/// The pipe's axis: as drawn, or a straight line eastwards.
std::vector<Vector3d> MakeLine_W(const DetectPipe& pipe, double length_m) {
  if (pipe.line_m.empty()) return {{0, 0, 0}, {length_m, 0, 0}};
  std::vector<Vector3d> line_W;
  for (std::size_t i = 0; i + 2 < pipe.line_m.size(); i += 3)
    line_W.emplace_back(pipe.line_m[i], pipe.line_m[i + 1], pipe.line_m[i + 2]);
  if (line_W.size() < 2) throw InputError("one point is no line; give two or more", "line_m");
  return line_W;
}

Network MakeDetectNetwork(const DetectPipe& pipe, double length_m) {
  const std::vector<Vector3d> line_W = MakeLine_W(pipe, length_m);
  const WallParams& wall = pipe.wall;
  PipeSpec spec;
  spec.id = "P1";
  spec.from = "A";
  spec.to = "B";
  spec.diameter_m = pipe.diameter_m;
  spec.wall_thickness_m = pipe.wall_thickness_m;
  spec.vertices_m.assign(line_W.begin() + 1, line_W.end() - 1);
  spec.bend_radius_m = kBendRadius_diameters * pipe.diameter_m;
  spec.fit_bends = true;
  spec.length_m = pipe.length_m.value_or(0);
  spec.material = {pipe.material,      wall.young_modulus_Pa, wall.loss_factor,          wall.poisson_ratio,
                   wall.density_kg_m3, wall.roughness_m,      wall.relative_permeability};
  return Network({{"A", line_W.front()}, {"B", line_W.back()}}, {spec});
}

std::vector<estimator::Fitting> ListFittings(const DetectPipe& pipe) {
  std::vector<estimator::Fitting> fittings;
  for (const DetectFitting& fitting : pipe.fittings) {
    if (pipe.length_m && fitting.chainage_m > *pipe.length_m) {
      throw InputError("'" + fitting.id + "' lies at " + FormatNumber(fitting.chainage_m) +
                           " m; allowed: [0, " + FormatNumber(*pipe.length_m) + "] m, the pipe's length_m",
                       "fittings");
    }
    fittings.push_back({FittingKindOf(fitting.kind), fitting.id, 0, fitting.chainage_m});
  }
  return fittings;
}

estimator::EstimatorStart MakeStart(const DetectPipe& pipe, double length_m) {
  Network network = MakeDetectNetwork(pipe, length_m);
  Route route(network, {{0, false}});
  estimator::EstimatorStart start;
  start.map = estimator::RouteMap{std::move(network), std::move(route), ListFittings(pipe)};
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
      nav.chainage_sd_m = way_.Sd_m(t_s);
      nav.p_W = {nav.chainage_m, 0, 0};
      locator.IngestNav(nav);
    }
  }

 private:
  const Way& way_;
  std::int64_t next_ = 0;
};

}  // namespace

void DetectFitting::Visit(ParamVisitor& v) {
  v.Text({"id", "Name of the fitting.", true}, id);
  v.Choice({"kind", "What it is."}, std::array<std::string_view, 3>{"pump", "valve", "service"}, kind);
  v.Number({"chainage_m", "Where it is.", true}, Range::NonNegative(), chainage_m);
}

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
  v.Number({"speed_sd_m_s", "How well that speed is known, standard deviation; intervals then hold it."},
           Range::NonNegative(), speed_sd_m_s);
  v.Number({"start_chainage_m", "Where the record begins, when no track is given."}, Range::Any(),
           start_chainage_m);
  v.Number({"full_scale_Pa", "Pressure of the largest sample the file can hold."}, Range::Positive(),
           full_scale_Pa);
  v.Items({"fittings", "Pumps, valves and services along the pipe: detections at them are flagged."},
          fittings);
  v.Table({"line_m", "The pipe's axis, rows of east, north, up, for dig points."}, Range::Between(-1e6, 1e6),
          3, line_m);
  v.Struct({"origin", "Where on earth those coordinates begin."}, origin);
  v.Struct({"locator", "How leaks are told, where the command line does not say."}, locator);
}

DetectPipe LoadDetectPipe(const std::filesystem::path& path) {
  DetectPipe pipe;
  YamlDocument::FromFile(path.string()).Read([&](ParamVisitor& v) { pipe.Visit(v); });
  return pipe;
}

namespace {

/// Leaks where the drawn pipe has their chainages.
void PlaceOnEarth(const DetectPipe& pipe, const estimator::RouteMap& map, Detections& result) {
  for (estimator::LeakEstimate& leak : result.leaks) leak.p_W = map.route.Eval(leak.chainage_m).p_W;
  if (pipe.origin.known()) result.origin = pipe.origin;
}

}  // namespace

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
  result.interval_holds = way.DescribeErrors();
  if (options.pipe && !options.pipe->line_m.empty()) PlaceOnEarth(*options.pipe, *start.map, result);
  result.levels = levels.Take();
  return result;
}

}  // namespace piperun::scenarios
