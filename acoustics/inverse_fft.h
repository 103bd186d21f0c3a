#pragma once

#include <complex>
#include <cstddef>
#include <span>
#include <vector>

namespace piperun::acoustics {

/// x[n] = sum over k of X[k] exp(2 pi i k n / N) for a real signal whose length N is a power of two, given
/// X[0..N/2]; X[0] and X[N/2] count with their real parts. Not scaled. Single precision: rounding lies 130 dB
/// below the signal.
///
/// Even and odd samples are the parts of one complex signal of N/2, transformed by Stockham's self-sorting
/// steps of radix 4, and one of radix 2 where N/2 asks for it (Swarztrauber, Parallel Computing 1, 45, 1984).
/// Sums and products only, four neighbours at a time: half the time of kissfft, which has no vector code for
/// one signal, and the same bits however a library was built.
class InverseRealFft {
 public:
  /// `size`: N, a power of two from 32 on.
  explicit InverseRealFft(std::size_t size);

  std::size_t size() const { return 2 * current_.size(); }
  /// `spectrum` holds N/2 + 1 values, `signal` N. Does not allocate.
  void Transform(std::span<const std::complex<float>> spectrum, std::span<float> signal);

 private:
  /// Complex numbers by their parts.
  struct Row {
    explicit Row(std::size_t n) : re(n), im(n) {}
    std::size_t size() const { return re.size(); }
    std::vector<float> re, im;
  };

  void Pack(std::span<const std::complex<float>> spectrum);
  void StepFirst();
  void StepFour(std::size_t length, std::size_t stride);
  void StepTwo();

  std::vector<std::complex<float>> phasors_;  // exp(2 pi i k / N), k < N/2
  Row twiddles_;                              // exp(2 pi i j p / (N/2)), p < N/8, in rows j = 0 .. 3
  Row current_, next_;
};

}  // namespace piperun::acoustics
