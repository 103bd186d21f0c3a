// Receivers above ground that log the ball's passage.

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "base/number.h"
#include "sim/joined_drawing.h"
#include "sim/marker_passage.h"
#include "sim/sensor.h"

namespace piperun::sim::sensors::marker {
namespace {

struct ReceiverParams {
  std::string id;
  std::string pipe;
  double s_m = 0;
  double cover_m = 1;
  double aside_m = 0;

  void Visit(ParamVisitor& v) {
    v.Text({"id", "Name of the receiver."}, id);
    v.Text({"pipe", "The pipe it stands above.", true}, pipe);
    v.Number({"s_m", "Where, along the pipe.", true}, Range::NonNegative(), s_m);
    v.Number({"cover_m", "Height above the pipe's axis."}, Range::Between(0, 100), cover_m);
    v.Number({"aside_m", "How far beside the pipe, to the left of its s."}, Range::Between(-100, 100),
             aside_m);
  }
};

struct MarkerParams : ParamsOf<MarkerParams> {
  std::vector<ReceiverParams> receivers;
  double range_m = 3;
  double clock_offset_sd_s = 0;
  double clock_drift_sd_ppm = 0;
  double jitter_sd_s = 0;
  double missed = 0;
  double false_passes_1_h = 0;
  double survey_sd_m = 0;

  void Visit(ParamVisitor& v) override {
    v.Items({"receivers", "Where they stand."}, receivers);
    v.Number({"range_m", "Slant distance up to which a receiver hears the ball."}, Range::Between(0.1, 1000),
             range_m);
    v.Number({"clock_offset_sd_s", "Offset of a receiver's clock: standard deviation, drawn for each."},
             Range::Between(0, 3600), clock_offset_sd_s);
    v.Number({"clock_drift_sd_ppm", "Drift of a receiver's clock: standard deviation, drawn for each."},
             Range::Between(0, 1e4), clock_drift_sd_ppm);
    v.Number({"jitter_sd_s", "Logged time: standard deviation, drawn for each pass."},
             Range::Between(0, 3600), jitter_sd_s);
    v.Number({"missed", "Share of the passes that a receiver does not log."}, Range::Between(0, 1), missed);
    v.Number({"false_passes_1_h", "Passes per hour and receiver that no ball made."}, Range::Between(0, 3600),
             false_passes_1_h);
    v.Number({"survey_sd_m", "Surveyed place: standard deviation along each axis."}, Range::Between(0, 100),
             survey_sd_m);
  }
};

// Slots; samples below are receiver << 32 | pass.
constexpr std::uint64_t kClockSlot = 0, kSurveySlot = 1, kJitterSlot = 2, kMissedSlot = 3, kFalseSlot = 4;

struct Receiver {
  int pipe = 0;
  Vector3d p_W;           // true
  Vector3d p_surveyed_W;  // as the crew knows it
  double clock_offset_s = 0;
  double clock_rate = 1;
  PassageDetector detector;
  std::optional<JoinedDrawing> drawing{};  // of the pipe that the ball is in
  std::uint64_t passes = 0;                // so far, missed ones included
};

int FindPipe(const SensorContext& context, const ReceiverParams& params) {
  const int index = context.network->RequirePipe(params.pipe, "pipe");
  const Pipe& pipe = context.network->pipe(index);
  if (params.s_m > pipe.length_m) {
    throw InputError(FormatNumber(params.s_m) + " m is beyond the end of pipe '" + pipe.id +
                         "'; allowed: [0, " + FormatNumber(pipe.length_m) + "] m",
                     "s_m");
  }
  return index;
}

void RequireHearing(const ReceiverParams& receiver, double range_m) {
  const double distance_m = std::hypot(receiver.cover_m, receiver.aside_m);
  if (distance_m < range_m) return;
  throw InputError("it stands " + FormatDigits(distance_m, 4) + " m from its pipe's axis and hears up to " +
                       FormatNumber(range_m) + " m: no ball ever; place it nearer or raise range_m",
                   std::abs(receiver.aside_m) > receiver.cover_m ? "aside_m" : "cover_m");
}

void RefuseTwins(const std::vector<ReceiverParams>& receivers) {
  for (std::size_t i = 0; i < receivers.size(); ++i) {
    const auto same = [&](const ReceiverParams& other) { return other.id == receivers[i].id; };
    const auto end = receivers.begin() + static_cast<std::ptrdiff_t>(i);
    if (receivers[i].id.empty() || std::none_of(receivers.begin(), end, same)) continue;
    throw InputError("two receivers are called '" + receivers[i].id + "'; give each a name of its own",
                     "receivers[" + std::to_string(i) + "].id");
  }
}

/// Above and beside the pipe's axis as it is drawn.
Vector3d FindPlace(const Pipe& pipe, const ReceiverParams& params) {
  const CentrelinePoint axis = pipe.Eval(params.s_m);
  const Vector3d left = Vector3d::UnitZ().cross(axis.tangent_W);
  const Vector3d aside = left.norm() > 0 ? Vector3d(left.normalized()) : Vector3d::UnitX();
  return axis.p_W + params.cover_m * Vector3d::UnitZ() + params.aside_m * aside;
}

/// A receiver stands above the network as its own pipe is drawn; a pipe that meets it is moved to where they
/// meet (sim/joined_drawing.h). What it hears is the ball at the axis of the pipe, whose few centimetres from
/// it mean nothing at that distance. A pass is logged as
///
///   (1 + drift) t + offset + jitter,   t the true time of the closest approach (sim/marker_passage.h),
///
/// by a clock of the receiver's own. The crew compares clocks when it puts the ball in: stamps are on the
/// ball's clock there, and drift apart from it later. Logs are read out after the run.
class MarkerSensor final : public Sensor {
 public:
  MarkerSensor(const MarkerParams& params, const SensorContext& context)
      : params_(params), context_(context) {
    for (std::size_t i = 0; i < params.receivers.size(); ++i) receivers_.push_back(MakeReceiver(i));
  }

  /// How often the truth is looked at; every step of it is.
  Rate rate() const override { return Rate(20); }
  TrueTime DueTime(std::int64_t k) const override { return SampleTime(k, rate()); }
  Pose X_BS() const override { return {}; }

  SensorValue Sample(std::int64_t k, const TruthWindow& window) override {
    const std::int64_t end = window.StepAt(DueTime(k));
    for (; next_step_ <= end; ++next_step_) Watch(window.at(next_step_));
    return LostSample{};
  }

  std::vector<MarkerPass> ReadOut(const TruthWindow& window) override {
    for (; next_step_ <= window.last(); ++next_step_) Watch(window.at(next_step_));
    const double duration_s = Seconds(window.latest_time());
    for (std::size_t i = 0; i < receivers_.size(); ++i) {
      if (const auto passage = receivers_[i].detector.End()) Log(i, *passage);
      AddFalsePasses(i, duration_s);
    }
    std::sort(log_.begin(), log_.end(), [](const MarkerPass& a, const MarkerPass& b) {
      return a.stamp < b.stamp || (a.stamp == b.stamp && a.receiver < b.receiver);
    });
    return std::move(log_);
  }

 private:
  static std::uint64_t Draw(std::size_t receiver, std::uint64_t pass) {
    return static_cast<std::uint64_t>(receiver) << 32 | pass;
  }

  Receiver MakeReceiver(std::size_t i) const {
    const auto n = context_.random.Normals(Draw(i, 0), kClockSlot);
    const auto survey = context_.random.Normals(Draw(i, 0), kSurveySlot);
    try {
      const int pipe = FindPipe(context_, params_.receivers[i]);
      RequireHearing(params_.receivers[i], params_.range_m);
      const Vector3d p_W = FindPlace(context_.network->pipe(pipe), params_.receivers[i]);
      return {pipe,
              p_W,
              p_W + params_.survey_sd_m * Vector3d(survey[0], survey[1], survey[2]),
              params_.clock_offset_sd_s * n[0],
              1 + 1e-6 * params_.clock_drift_sd_ppm * n[1],
              PassageDetector(params_.range_m)};
    } catch (const InputError& e) {
      throw InputError(e.problem(), "receivers[" + std::to_string(i) + "]." + e.key_path());
    }
  }

  void Watch(const TruthState& ball) {
    if (ball.pipe < 0) return;
    if (ball.pipe != pipe_) EnterPipe(ball.pipe);
    const Vector3d p_W = context_.network->pipe(ball.pipe).Eval(ball.s_m).p_W;
    for (std::size_t i = 0; i < receivers_.size(); ++i) {
      Receiver& receiver = receivers_[i];
      const Vector3d p_RB_W = p_W + receiver.drawing->Shift_W(ball.s_m) - receiver.p_W;
      if (const auto passage = receiver.detector.Step(ball.time, p_RB_W.squaredNorm())) Log(i, *passage);
    }
  }

  void EnterPipe(int pipe) {
    pipe_ = pipe;
    for (Receiver& receiver : receivers_) {
      const bool met = receiver.drawing && receiver.drawing->meets();
      receiver.drawing.emplace(*context_.network, receiver.pipe, pipe);
      if (!met || !receiver.drawing->meets()) receiver.detector.Jump();
    }
  }

  void Log(std::size_t i, const Passage& passage) {
    const std::uint64_t draw = Draw(i, ++receivers_[i].passes);
    if (context_.random.Uniforms(draw, kMissedSlot)[0] < params_.missed) return;
    Log(i, Seconds(passage.time), params_.jitter_sd_s * context_.random.Normals(draw, kJitterSlot)[0]);
  }

  void Log(std::size_t i, double t_s, double jitter_s) {
    const Receiver& receiver = receivers_[i];
    const double shown_s = receiver.clock_rate * t_s + receiver.clock_offset_s + jitter_s;
    log_.push_back({context_.clock.ToRobot(TrueTime{}) + FromSeconds(shown_s), static_cast<int>(i),
                    receiver.p_surveyed_W});
  }

  /// A Poisson process: exponential times between.
  void AddFalsePasses(std::size_t i, double duration_s) {
    if (params_.false_passes_1_h == 0) return;
    double t_s = 0;
    for (std::uint64_t pass = 1;; ++pass) {
      const double u = context_.random.Uniforms(Draw(i, pass), kFalseSlot)[0];
      t_s -= 3600 / params_.false_passes_1_h * std::log(u);
      if (t_s > duration_s) return;
      Log(i, t_s, 0);
    }
  }

  MarkerParams params_;
  SensorContext context_;
  std::vector<Receiver> receivers_;
  std::int64_t next_step_ = 0;
  int pipe_ = -1;
  std::vector<MarkerPass> log_;
};

std::unique_ptr<Sensor> Make(const Params& params, const SensorContext& context) {
  const auto& p = static_cast<const MarkerParams&>(params);
  if (!context.network)
    throw InputError("a marker stands above a pipe, and this scenario has no network", "");
  if (p.receivers.empty()) throw InputError("there is no receiver; state one: {pipe, s_m}", "receivers");
  RefuseTwins(p.receivers);
  return std::make_unique<MarkerSensor>(p, context);
}

}  // namespace

SensorKind Kind() {
  return {"marker", "Receivers above ground that log the ball's passage; read out after the run.", "marker",
          MakeParams<MarkerParams>, Make};
}

}  // namespace piperun::sim::sensors::marker
