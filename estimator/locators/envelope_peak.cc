#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include "estimator/frame_locator.h"

namespace piperun::estimator::locators::envelope_peak {
namespace {

constexpr double kRelease = 0.7;  // a peak is over when the envelope has fallen to this fraction of it

struct EnvelopePeakParams : ParamsOf<EnvelopePeakParams> {
  BandParams bands;
  double smooth_s = 2;
  double background_s = 60;
  double threshold_dB = 3;
  std::int64_t max_leaks = 1;

  void Visit(ParamVisitor& v) override {
    bands.Visit(v);
    v.Number({"smooth_s", "Length of the Hann window the envelope is convolved with."}, Range::Positive(),
             smooth_s);
    v.Number({"background_s", "Length of record whose median is the background."}, Range::Positive(),
             background_s);
    v.Number({"threshold_dB", "A peak must exceed the background by this much."}, Range::NonNegative(),
             threshold_dB);
    v.Integer({"max_leaks", "How many peaks are reported, highest first; the thesis has one."}, 1, 1000,
              max_leaks);
  }
};

/// A ring of the last n values.
template <class T>
class Recent {
 public:
  explicit Recent(std::size_t n) : ring_(n) {}
  void Push(const T& value) {
    ring_[next_ % ring_.size()] = value;
    ++next_;
  }
  std::size_t size() const { return std::min(next_, ring_.size()); }
  std::size_t capacity() const { return ring_.size(); }
  bool full() const { return next_ >= ring_.size(); }
  /// Age 0 is the newest.
  const T& Back(std::size_t age) const { return ring_[(next_ - 1 - age) % ring_.size()]; }
  /// All of them, in no particular order.
  std::span<const T> Values() const { return std::span<const T>(ring_).first(size()); }

 private:
  std::vector<T> ring_;
  std::size_t next_ = 0;
};

std::vector<double> HannKernel(std::size_t n) {
  std::vector<double> kernel(n);
  double sum = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const double s = std::sin(std::numbers::pi * (static_cast<double>(i) + 0.5) / static_cast<double>(n));
    sum += kernel[i] = s * s;
  }
  for (double& k : kernel) k /= sum;
  return kernel;
}

/// One value of the smoothed envelope, where the ball was.
struct Smoothed {
  double envelope_Pa = 0;
  TrackPoint ball;
};

struct Candidate {
  double ratio = 0;  // of envelope to background
  LeakEstimate leak;
};

/// The thesis' method (section 6.3): the rectified, band-passed sound is smoothed by convolution; the time of
/// its peak is the time of the leak, and where the ball was then is the leak. A peak begins above the
/// threshold over the running median and ends when the envelope has fallen to 0.7 of it. sigma: the envelope
/// is taken as a parabola at its peak whose height is known to the scatter of neighbouring frames (smoothed).
/// confidence: 1 - background / peak, an ordering and not a probability.
class EnvelopePeak final : public FrameLocator {
 public:
  explicit EnvelopePeak(const EnvelopePeakParams& params);

 private:
  void Consume(const LocatedFrame& frame) override;
  void Complete() override;
  void Follow(const Smoothed& now);
  double Background_Pa();
  void TakePeak();
  LeakEstimate MakeEstimate() const;

  EnvelopePeakParams params_;
  std::vector<double> kernel_;
  Recent<LocatedFrame> raw_;
  Recent<double> background_;
  std::vector<double> sorted_;
  Smoothed last_[3];  // the latest three smoothed values
  std::size_t smoothed_ = 0;
  bool in_peak_ = false;
  double valley_Pa_ = 0;  // lowest envelope since the last peak
  Smoothed around_[3];    // the peak and its neighbours
  bool await_after_ = false;
  double floor_Pa_ = 0;   // background when the peak began
  double noise_Pa2_ = 0;  // running mean square of the second difference of frames / 6
  std::vector<Candidate> candidates_;
};

EnvelopePeak::EnvelopePeak(const EnvelopePeakParams& params)
    : FrameLocator(BandFrames(params.bands, true)),
      params_(params),
      kernel_(HannKernel(
          std::max<std::size_t>(1, static_cast<std::size_t>(params.smooth_s / params.bands.frame_s)))),
      raw_(std::max<std::size_t>(3, kernel_.size())),
      background_(
          std::max<std::size_t>(1, static_cast<std::size_t>(params.background_s / params.bands.frame_s))) {
  sorted_.reserve(background_.capacity());
  candidates_.reserve(static_cast<std::size_t>(params.max_leaks) + 1);
}

void EnvelopePeak::Consume(const LocatedFrame& frame) {
  raw_.Push(frame);
  background_.Push(frame.sound.rectified_Pa);
  if (!raw_.full()) return;
  Smoothed now;
  for (std::size_t i = 0; i < kernel_.size(); ++i)
    now.envelope_Pa += kernel_[i] * raw_.Back(i).sound.rectified_Pa;
  now.ball = raw_.Back(kernel_.size() / 2).ball;
  const double second =
      raw_.Back(0).sound.rectified_Pa - 2 * raw_.Back(1).sound.rectified_Pa + raw_.Back(2).sound.rectified_Pa;
  noise_Pa2_ +=
      (second * second / 6 - noise_Pa2_) / static_cast<double>(std::min<std::size_t>(++smoothed_, 200));
  Follow(now);
}

void EnvelopePeak::Follow(const Smoothed& now) {
  last_[0] = last_[1];
  last_[1] = last_[2];
  last_[2] = now;
  if (await_after_) {
    around_[2] = now;
    await_after_ = false;
  }
  if (!in_peak_) {
    const double floor_Pa = Background_Pa();
    valley_Pa_ = std::min(valley_Pa_, now.envelope_Pa);
    if (now.envelope_Pa < floor_Pa * std::pow(10, params_.threshold_dB / 20)) return;
    if (now.envelope_Pa * kRelease < valley_Pa_) return;  // still on the flank of the peak before
    in_peak_ = true;
    floor_Pa_ = floor_Pa;
    around_[1].envelope_Pa = 0;
  }
  if (now.envelope_Pa > around_[1].envelope_Pa) {
    around_[0] = smoothed_ > 1 ? last_[1] : now;
    around_[1] = around_[2] = now;
    await_after_ = true;
  } else if (now.envelope_Pa < kRelease * around_[1].envelope_Pa) {
    TakePeak();
  }
}

double EnvelopePeak::Background_Pa() {
  const auto values = background_.Values();
  sorted_.assign(values.begin(), values.end());
  const auto middle = sorted_.begin() + static_cast<std::ptrdiff_t>(sorted_.size() / 2);
  std::nth_element(sorted_.begin(), middle, sorted_.end());
  return *middle;
}

LeakEstimate EnvelopePeak::MakeEstimate() const {
  const double a = around_[0].envelope_Pa, b = around_[1].envelope_Pa, c = around_[2].envelope_Pa;
  const double bend = 2 * b - a - c;  // minus the second difference
  const double shift = bend > 0 ? std::clamp(0.5 * (c - a) / bend, -0.5, 0.5) : 0;
  const Smoothed& towards = shift < 0 ? around_[0] : around_[2];
  const TrackPoint& peak = around_[1].ball;
  const double u = std::abs(shift);
  LeakEstimate leak;
  leak.t_cpa = peak.time + FromSeconds(u * Seconds(towards.ball.time - peak.time));
  leak.chainage_m = peak.chainage_m + u * (towards.ball.chainage_m - peak.chainage_m);
  leak.p_W = peak.p_W + u * (towards.ball.p_W - peak.p_W);
  // half width over which the parabola falls by the scatter of a smoothed value
  const double scatter = std::sqrt(noise_Pa2_ / (0.67 * static_cast<double>(kernel_.size())));
  const double frames = bend > 0 ? std::sqrt(2 * scatter / bend) : static_cast<double>(kernel_.size());
  const double per_frame_m = 0.5 * std::abs(around_[2].ball.chainage_m - around_[0].ball.chainage_m);
  leak.sigma_m = std::hypot(frames * per_frame_m, peak.chainage_sd_m);
  leak.interval = CalcNormalInterval(leak.chainage_m, leak.sigma_m);
  leak.confidence = std::clamp(1 - floor_Pa_ / b, 0.0, 1.0);
  return leak;
}

void EnvelopePeak::TakePeak() {
  in_peak_ = false;
  valley_Pa_ = last_[2].envelope_Pa;
  await_after_ = false;
  candidates_.push_back({around_[1].envelope_Pa / floor_Pa_, MakeEstimate()});
  std::sort(candidates_.begin(), candidates_.end(),
            [](const Candidate& a, const Candidate& b) { return a.ratio > b.ratio; });
  if (candidates_.size() > static_cast<std::size_t>(params_.max_leaks)) candidates_.pop_back();
}

void EnvelopePeak::Complete() {
  if (in_peak_) TakePeak();
  for (const Candidate& candidate : candidates_) Report(candidate.leak);
}

std::unique_ptr<LeakLocator> Make(const Params& params, const EstimatorStart&) {
  return std::make_unique<EnvelopePeak>(dynamic_cast<const EnvelopePeakParams&>(params));
}

}  // namespace

LocatorKind Kind() {
  return {"envelope_peak",
          "Envelope of the sound, smoothed by convolution; its peak is the leak (the thesis).",
          MakeParams<EnvelopePeakParams>, Make};
}

}  // namespace piperun::estimator::locators::envelope_peak
