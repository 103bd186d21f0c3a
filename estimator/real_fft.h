#pragma once

#include <complex>
#include <cstddef>
#include <memory>
#include <span>

namespace piperun::estimator {

/// Discrete Fourier transform of a real signal of even length N in single precision,
///   X[k] = sum over n of x[n] exp(-2 pi i k n / N),   k = 0 .. N/2,
/// and its inverse without the factor 1/N. Does not allocate after construction.
class RealFft {
 public:
  explicit RealFft(std::size_t size);
  ~RealFft();
  RealFft(RealFft&&) noexcept;

  std::size_t size() const { return size_; }
  std::size_t bins() const { return size_ / 2 + 1; }
  /// `signal` holds N values, `spectrum` N/2 + 1.
  void Forward(std::span<const float> signal, std::span<std::complex<float>> spectrum);
  /// N times the inverse: after Forward and Inverse a signal is N times itself.
  void Inverse(std::span<const std::complex<float>> spectrum, std::span<float> signal);

 private:
  struct Plan;
  std::size_t size_;
  std::unique_ptr<Plan> plan_;
};

}  // namespace piperun::estimator
