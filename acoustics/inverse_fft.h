#pragma once

#include <complex>
#include <cstddef>
#include <memory>
#include <span>

namespace piperun::acoustics {

/// x[n] = sum over k of X[k] exp(2 pi i k n / N) for a real signal of even length N, given X[0..N/2]; X[0]
/// and X[N/2] count with their real parts. Not scaled. Single precision: rounding lies 140 dB below the
/// signal.
class InverseRealFft {
 public:
  explicit InverseRealFft(std::size_t size);
  ~InverseRealFft();
  InverseRealFft(InverseRealFft&&) noexcept;

  std::size_t size() const { return size_; }
  /// `spectrum` holds N/2 + 1 values, `signal` N. Does not allocate.
  void Transform(std::span<const std::complex<float>> spectrum, std::span<float> signal);

 private:
  struct Plan;
  std::size_t size_;
  std::unique_ptr<Plan> plan_;
};

}  // namespace piperun::acoustics
