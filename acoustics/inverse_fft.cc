#include "acoustics/inverse_fft.h"

#include <bit>
#include <cmath>
#include <cstring>
#include <numbers>
#include <utility>

#include "base/function_clones.h"
#include "base/check.h"

namespace piperun::acoustics {
namespace {

std::complex<float> CalcPhasor(std::size_t k, std::size_t n) {
  const double angle = 2 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(n);
  return {static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle))};
}

/// Four neighbours.
using Lanes [[gnu::vector_size(16)]] = float;

Lanes Load(const float* from) {
  Lanes lanes;
  std::memcpy(&lanes, from, sizeof(lanes));
  return lanes;
}

void Store(const Lanes& lanes, float* to) { std::memcpy(to, &lanes, sizeof(lanes)); }

/// Four complex numbers, or what four are multiplied by; of each, four neighbours.
struct Four {
  Lanes re[4], im[4];
};

/// Every `stride`-th of a row.
Four Load(const float* re, const float* im, std::size_t stride) {
  return {{Load(re), Load(re + stride), Load(re + 2 * stride), Load(re + 3 * stride)},
          {Load(im), Load(im + stride), Load(im + 2 * stride), Load(im + 3 * stride)}};
}

/// y[j] = w_j sum over l of i^(jl) x[l], w_0 = 1.
Four Combine(const Four& x, const Four& w) {
  const Lanes sum_02_re = x.re[0] + x.re[2], sum_02_im = x.im[0] + x.im[2];
  const Lanes dif_02_re = x.re[0] - x.re[2], dif_02_im = x.im[0] - x.im[2];
  const Lanes sum_13_re = x.re[1] + x.re[3], sum_13_im = x.im[1] + x.im[3];
  const Lanes dif_13_re = x.re[1] - x.re[3], dif_13_im = x.im[1] - x.im[3];
  const Lanes re[4]{sum_02_re + sum_13_re, dif_02_re - dif_13_im, sum_02_re - sum_13_re,
                    dif_02_re + dif_13_im};
  const Lanes im[4]{sum_02_im + sum_13_im, dif_02_im + dif_13_re, sum_02_im - sum_13_im,
                    dif_02_im - dif_13_re};
  Four y{{re[0]}, {im[0]}};
  for (int j = 1; j < 4; ++j) {
    y.re[j] = re[j] * w.re[j] - im[j] * w.im[j];
    y.im[j] = re[j] * w.im[j] + im[j] * w.re[j];
  }
  return y;
}

/// Neighbour by neighbour, each with its four numbers in a row.
void StoreTransposed(const Lanes (&x)[4], float* to) {
  const Lanes low_01 = __builtin_shufflevector(x[0], x[1], 0, 4, 1, 5);
  const Lanes low_23 = __builtin_shufflevector(x[2], x[3], 0, 4, 1, 5);
  const Lanes high_01 = __builtin_shufflevector(x[0], x[1], 2, 6, 3, 7);
  const Lanes high_23 = __builtin_shufflevector(x[2], x[3], 2, 6, 3, 7);
  Store(__builtin_shufflevector(low_01, low_23, 0, 1, 4, 5), to);
  Store(__builtin_shufflevector(low_01, low_23, 2, 3, 6, 7), to + 4);
  Store(__builtin_shufflevector(high_01, high_23, 0, 1, 4, 5), to + 8);
  Store(__builtin_shufflevector(high_01, high_23, 2, 3, 6, 7), to + 12);
}

/// One number for all neighbours.
Lanes Repeat(float x) { return Lanes{x, x, x, x}; }

}  // namespace

InverseRealFft::InverseRealFft(std::size_t size) : twiddles_(size / 2), current_(size / 2), next_(size / 2) {
  Demand(size >= 32 && std::has_single_bit(size), "the transform's size is a power of two from 32 on");
  for (std::size_t k = 0; k < size / 2; ++k) phasors_.push_back(CalcPhasor(k, size));
  const std::size_t quarter = size / 8;
  for (std::size_t p = 0; p < size / 2; ++p) {
    const std::complex<float> w = CalcPhasor(p / quarter * (p % quarter), size / 2);
    twiddles_.re[p] = w.real();
    twiddles_.im[p] = w.imag();
  }
}

void InverseRealFft::Transform(std::span<const std::complex<float>> spectrum, std::span<float> signal) {
  const std::size_t half = current_.size();
  Demand(spectrum.size() == half + 1 && signal.size() == 2 * half, "sizes match the transform");
  Pack(spectrum);
  std::size_t length = half;
  for (; length >= 4; length /= 4) {
    if (length == half) {
      StepFirst();
    } else {
      StepFour(length, half / length);
    }
    std::swap(current_, next_);
  }
  if (length == 2) {
    StepTwo();
    std::swap(current_, next_);
  }
  for (std::size_t m = 0; m < half; ++m) {
    signal[2 * m] = current_.re[m];
    signal[2 * m + 1] = current_.im[m];
  }
}

/// Z_k = A + T and Z_(M-k) = conj(A - T) with A = X_k + conj X_(M-k), T = i exp(2 pi i k/N) (X_k - conj
/// X_(M-k)), M = N/2: the spectrum of x[2m] + i x[2m+1].
PIPERUN_CLONE_FOR("avx2")
void InverseRealFft::Pack(std::span<const std::complex<float>> spectrum) {
  const std::size_t half = current_.size();
  const float first = spectrum.front().real(), last = spectrum.back().real();
  current_.re[0] = first + last;
  current_.im[0] = first - last;
  for (std::size_t k = 1; k <= half / 2; ++k) {
    const std::complex<float> x = spectrum[k], y = spectrum[half - k], w = phasors_[k];
    const float a_re = x.real() + y.real(), a_im = x.imag() - y.imag();
    const float b_re = x.real() - y.real(), b_im = x.imag() + y.imag();
    const float t_re = -(w.real() * b_im + w.imag() * b_re), t_im = w.real() * b_re - w.imag() * b_im;
    current_.re[half - k] = a_re - t_re;
    current_.im[half - k] = t_im - a_im;
    current_.re[k] = a_re + t_re;
    current_.im[k] = a_im + t_im;
  }
}

/// The step of stride one: neighbours have twiddles of their own, and their results lie side by side.
void InverseRealFft::StepFirst() {
  const std::size_t quarter = current_.size() / 4;
  for (std::size_t p = 0; p < quarter; p += 4) {
    const Four w = Load(twiddles_.re.data() + p, twiddles_.im.data() + p, quarter);
    const Four y = Combine(Load(current_.re.data() + p, current_.im.data() + p, quarter), w);
    StoreTransposed(y.re, next_.re.data() + 4 * p);
    StoreTransposed(y.im, next_.im.data() + 4 * p);
  }
}

void InverseRealFft::StepFour(std::size_t length, std::size_t stride) {
  const std::size_t quarter = current_.size() / 4;
  for (std::size_t p = 0; p < length / 4; ++p) {
    Four w{};
    for (std::size_t j = 1; j < 4; ++j) {  // exp(2 pi i j p / length)
      w.re[j] = Repeat(twiddles_.re[j * quarter + p * stride]);
      w.im[j] = Repeat(twiddles_.im[j * quarter + p * stride]);
    }
    for (std::size_t q = p * stride; q < (p + 1) * stride; q += 4) {
      const Four y = Combine(Load(current_.re.data() + q, current_.im.data() + q, quarter), w);
      const std::size_t to = 3 * p * stride + q;
      for (std::size_t j = 0; j < 4; ++j) {
        Store(y.re[j], next_.re.data() + to + j * stride);
        Store(y.im[j], next_.im.data() + to + j * stride);
      }
    }
  }
}

void InverseRealFft::StepTwo() {
  const std::size_t stride = current_.size() / 2;
  for (std::size_t q = 0; q < stride; ++q) {
    next_.re[q] = current_.re[q] + current_.re[q + stride];
    next_.im[q] = current_.im[q] + current_.im[q + stride];
    next_.re[q + stride] = current_.re[q] - current_.re[q + stride];
    next_.im[q + stride] = current_.im[q] - current_.im[q + stride];
  }
}

}  // namespace piperun::acoustics
