#pragma once

#include <cmath>
#include <complex>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

namespace piperun::acoustics {

inline double MeanSquare(std::span<const double> x) {
  double sum = 0;
  for (const double v : x) sum += v * v;
  return sum / static_cast<double>(x.size());
}

inline double Kurtosis(std::span<const double> x) {
  double m2 = 0, m4 = 0;
  for (const double v : x) {
    m2 += v * v;
    m4 += v * v * v * v;
  }
  return m4 * static_cast<double>(x.size()) / (m2 * m2);
}

inline double Correlation(std::span<const double> x, std::span<const double> y) {
  double xy = 0;
  for (std::size_t i = 0; i < x.size(); ++i) xy += x[i] * y[i];
  return xy / std::sqrt(MeanSquare(x) * MeanSquare(y)) / static_cast<double>(x.size());
}

/// Discrete Fourier transform of a power of two of values (Cooley & Tukey), independent of the library under
/// test.
inline void Fft(std::vector<std::complex<double>>& x) {
  const std::size_t n = x.size();
  for (std::size_t i = 1, j = 0; i < n; ++i) {  // bit-reversed order
    std::size_t bit = n >> 1;
    for (; j & bit; bit >>= 1) j ^= bit;
    j ^= bit;
    if (i < j) std::swap(x[i], x[j]);
  }
  for (std::size_t size = 2; size <= n; size *= 2) {
    for (std::size_t k = 0; k < size / 2; ++k) {
      const auto turn =
          std::polar(1.0, -2 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(size));
      for (std::size_t i = k; i < n; i += size) {
        const auto odd = turn * x[i + size / 2];
        x[i + size / 2] = x[i] - odd;
        x[i] += odd;
      }
    }
  }
}

/// One-sided PSD by Welch's method: Hann windows of `size` samples, half overlapped.
inline std::vector<double> Welch(std::span<const double> x, std::size_t size, double rate_Hz) {
  std::vector<double> psd(size / 2 + 1, 0);
  double count = 0;
  for (std::size_t start = 0; start + size <= x.size(); start += size / 2, ++count) {
    std::vector<std::complex<double>> frame(size);
    for (std::size_t n = 0; n < size; ++n) {
      const double s = std::sin(std::numbers::pi * static_cast<double>(n) / static_cast<double>(size));
      frame[n] = s * s * x[start + n];
    }
    Fft(frame);
    for (std::size_t k = 0; k < psd.size(); ++k) psd[k] += std::norm(frame[k]);
  }
  const double window_power = 0.375 * static_cast<double>(size);  // sum of sin^4
  for (double& p : psd) p *= 2 / (count * window_power * rate_Hz);
  return psd;
}

/// Integral of f over [low, high] by Simpson's rule in ln f.
template <class F>
double IntegrateLog(F f, double low, double high, int cells = 4000) {
  const double a = std::log(low), h = (std::log(high) - a) / cells;
  const auto g = [&](double u) { return f(std::exp(u)) * std::exp(u); };
  double sum = 0;
  for (int i = 0; i < cells; ++i) sum += g(a + i * h) + 4 * g(a + (i + 0.5) * h) + g(a + (i + 1) * h);
  return sum * h / 6;
}

}  // namespace piperun::acoustics
