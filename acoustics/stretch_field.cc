#include "acoustics/stretch_field.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "acoustics/decay.h"
#include "acoustics/phasor.h"
#include "base/function_clones.h"

namespace piperun::acoustics {
namespace {

constexpr double kStepsPerTurn = 64;
constexpr float kInaudibleLoss = 41;  // exp(-41) = -178 dB

/// The difference from the nearest whole number, |turns| < 4e6.
inline float WrapTurns(float turns) {
  constexpr float kRounder = 0x1.8p23F;
  return turns - ((turns + kRounder) - kRounder);
}

/// Multiples of a number of turns, less whole turns, in single precision: of its first 12 binary places the
/// multiples are exact, and the rest is small.
class Turns {
 public:
  explicit Turns(double turns) {
    const double part = turns - std::round(turns), coarse = std::round(part * 4096) / 4096;
    coarse_ = static_cast<float>(coarse);
    fine_ = static_cast<float>(part - coarse);
  }
  /// |k| < 4096
  float Multiple(int k) const {
    const auto factor = static_cast<float>(k);
    return WrapTurns(WrapTurns(factor * coarse_) + factor * fine_);
  }

 private:
  float coarse_, fine_;
};

/// Slow sums at two steps, and how far it is from the first to the second.
struct SlowSums {
  const float *re_0, *im_0, *re_1, *im_1;
  float share;
};

/// Re (C exp(-2 pi i phase)) of the bins from `begin` on.
template <class PhaseOf>
[[gnu::always_inline]] inline void AddTurned(const SlowSums& sums, int begin, int end, float* power_of_bins,
                                             PhaseOf phase_of) {
  const float* __restrict re_0 = sums.re_0, * __restrict im_0 = sums.im_0, * __restrict re_1 = sums.re_1, * __restrict im_1 = sums.im_1;
  const float share = sums.share;
  float* __restrict power = power_of_bins;
  for (int k = begin; k < end; ++k) {
    const Phasor fast = CalcPhasor(phase_of(k));
    const float re = re_0[k] + share * (re_1[k] - re_0[k]), im = im_0[k] + share * (im_1[k] - im_0[k]);
    power[k] += re * fast.cos + im * fast.sin;
  }
}

/// Single precision, and nothing below -60 dB re 1 uPa^2/Hz, 100 dB below what hydrophones make of
/// themselves: what is left of it after kInaudibleLoss would be a denormal number, and slow.
float Round(double psd) { return std::abs(psd) < 1e-18 ? 0 : static_cast<float>(psd); }

/// How many bins of a row of losses that do not fall are audible after so many metres.
int CountAudible(std::span<const float> power_loss_1_m, float way_m) {
  const auto inaudible = [way_m](float loss_1_m, float limit) { return loss_1_m * way_m < limit; };
  return static_cast<int>(
      std::lower_bound(power_loss_1_m.begin(), power_loss_1_m.end(), kInaudibleLoss, inaudible) -
      power_loss_1_m.begin());
}

}  // namespace

double StretchField::OffsetInBin(std::size_t bin, std::size_t part) {
  const auto fraction = [bin](double number) {
    const double multiple = static_cast<double>(bin) * number;
    return multiple - std::floor(multiple);
  };
  const double outer = 0.25 + 0.25 * fraction(std::numbers::phi);
  const double inner = 0.25 * fraction(std::numbers::sqrt2);
  const double offsets[kParts] = {-outer, -inner, inner, outer};
  return offsets[part];
}

StretchField::StretchField(double length_m, const PhaseRow& phases, std::size_t bins)
    : length_m_(length_m),
      turns_1_m_(phases.turns_1_m),
      excess_turns_1_m_(phases.excess_turns_1_m),
      forward_(bins),
      backward_(bins),
      re_0_(bins),
      im_0_(bins),
      re_1_(bins),
      im_1_(bins),
      power_(bins),
      slow_step_(std::numeric_limits<int>::min()) {
  for (std::size_t j = 0; j < kParts; ++j) {
    Part& part = parts_[j];
    part.re.resize(bins), part.im.resize(bins);
    for (std::size_t k = 0; k < bins; ++k) part.offset.push_back(static_cast<float>(OffsetInBin(k, j)));
    for (std::size_t k = 0; k < phases.slopes.size(); ++k) part.offset[k] *= phases.slopes[k];
  }
}

void StretchField::Set(std::size_t bin, const std::complex<double> (&forward)[kParts],
                       const std::complex<double> (&backward)[kParts], double attenuation_Np_m,
                       double weight) {
  const double share = weight / kParts;
  double forward_power = 0, backward_power = 0;
  for (std::size_t j = 0; j < kParts; ++j) {
    forward_power += share * std::norm(forward[j]);
    backward_power += share * std::norm(backward[j]);
    const auto cross =
        2 * share * std::exp(-attenuation_Np_m * length_m_) * forward[j] * std::conj(backward[j]);
    parts_[j].re[bin] = Round(cross.real());
    parts_[j].im[bin] = Round(cross.imag());
    if (parts_[j].re[bin] != 0 || parts_[j].im[bin] != 0)
      cross_bins_ = std::max(cross_bins_, static_cast<int>(bin) + 1);
  }
  forward_[bin] = Round(forward_power);
  backward_[bin] = Round(backward_power);
  const auto end = static_cast<int>(bin) + 1;
  if (forward_[bin] > 0) forward_bins_ = std::max(forward_bins_, end);
  if (backward_[bin] > 0) backward_bins_ = std::max(backward_bins_, end);
}

PIPERUN_CLONE_FOR("avx2")
void StretchField::Add(double x_m, std::span<const float> power_loss_1_m, std::span<float> psd) {
  const auto there_m = static_cast<float>(x_m), back_m = static_cast<float>(length_m_ - x_m);
  const int there = std::min(forward_bins_, CountAudible(power_loss_1_m, there_m));
  const int back = std::min(backward_bins_, CountAudible(power_loss_1_m, back_m));
  const int bins = std::max(there, back), standing = std::min(cross_bins_, bins);
  std::fill(power_.begin(), power_.begin() + bins, 0.F);
  AddWave(forward_, there_m, power_loss_1_m, there);
  AddWave(backward_, back_m, power_loss_1_m, back);
  if (standing > 0) AddStandingWave(x_m - 0.5 * length_m_, standing);
  const float* __restrict power = power_.data();
  float* __restrict sum = psd.data();
  for (int k = 1; k < bins; ++k) sum[k] += power[k] > 0 ? power[k] : 0;  // below: rounding, in a node
}

PIPERUN_CLONE_FOR("avx2")
void StretchField::AddWave(const std::vector<float>& wave, float way_m, std::span<const float> power_loss_1_m,
                           int bins) {
  const float* __restrict at_end = wave.data(), * __restrict loss = power_loss_1_m.data();
  float* __restrict power = power_.data();
  for (int k = 1; k < bins; ++k) power[k] += at_end[k] * CalcDecay(loss[k] * way_m);
}

PIPERUN_CLONE_FOR("avx2")
void StretchField::AddStandingWave(double from_middle_m, int bins) {
  const double u = turns_1_m_ * from_middle_m;  // turns per bin
  const double step = std::floor(kStepsPerTurn * u);
  if (static_cast<int>(step) != slow_step_) MoveSlowPhase(static_cast<int>(step));
  const SlowSums sums{re_0_.data(), im_0_.data(), re_1_.data(), im_1_.data(),
                      static_cast<float>(kStepsPerTurn * u - step)};
  const Turns turns(u);
  const float *excess = excess_turns_1_m_.data(), way_m = static_cast<float>(from_middle_m);
  const int dispersive = std::min(bins, static_cast<int>(excess_turns_1_m_.size()));
  AddTurned(sums, 1, dispersive, power_.data(),
            [=](int k) { return WrapTurns(turns.Multiple(k) + excess[k] * way_m); });
  AddTurned(sums, std::max(1, dispersive), bins, power_.data(), [=](int k) { return turns.Multiple(k); });
}

void StretchField::MoveSlowPhase(int step) {
  slow_step_ = step;
  SumSlowPhase(static_cast<float>(step / kStepsPerTurn), re_0_, im_0_);
  SumSlowPhase(static_cast<float>((step + 1) / kStepsPerTurn), re_1_, im_1_);
}

PIPERUN_CLONE_FOR("avx2")
void StretchField::SumSlowPhase(float turns, std::vector<float>& re, std::vector<float>& im) const {
  std::fill(re.begin(), re.end(), 0.F);
  std::fill(im.begin(), im.end(), 0.F);
  float* __restrict re_sum = re.data(), * __restrict im_sum = im.data();
  for (const Part& part : parts_) {
    const float *__restrict offset = part.offset.data(), *__restrict a = part.re.data(),
                    *__restrict b = part.im.data();
    for (int k = 1; k < cross_bins_; ++k) {
      const Phasor slow = CalcPhasor(WrapTurns(offset[k] * turns));
      re_sum[k] += a[k] * slow.cos + b[k] * slow.sin;
      im_sum[k] += b[k] * slow.cos - a[k] * slow.sin;
    }
  }
}

}  // namespace piperun::acoustics
