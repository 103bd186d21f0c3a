#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

namespace piperun::testing {

/// Overlapping Allan variance of a rate record at tau = m dt (IEEE Std 952-1997, annex C; NIST SP 1065, eq.
/// 11): half the mean square of the second difference of the integral, over tau^2. Textbook form.
inline double CalcAllanVariance(const std::vector<double>& rate, std::size_t m) {
  std::vector<double> angle(rate.size() + 1, 0.0);  // in units of dt
  for (std::size_t i = 0; i < rate.size(); ++i) angle[i + 1] = angle[i] + rate[i];
  const std::size_t count = angle.size() - 2 * m;
  double sum = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double d = angle[i + 2 * m] - 2 * angle[i + m] + angle[i];
    sum += d * d;
  }
  const double cluster = static_cast<double>(m);
  return sum / (2 * static_cast<double>(count) * cluster * cluster);
}

/// Equivalent degrees of freedom of the overlapping estimate for the noise types of a rate record of n
/// samples (N = n + 1 phase points): Howe, Allan & Barnes 1981, as table 5 of NIST SP 1065 (2008). The
/// estimate's relative standard deviation is sqrt(2 / edf).
inline double CalcEdfWhite(std::size_t n, std::size_t cluster) {
  const double N = static_cast<double>(n + 1), m = static_cast<double>(cluster);
  return (3 * (N - 1) / (2 * m) - 2 * (N - 2) / N) * 4 * m * m / (4 * m * m + 5);
}
inline double CalcEdfFlicker(std::size_t n, std::size_t cluster) {
  const double N = static_cast<double>(n + 1), m = static_cast<double>(cluster);
  return cluster == 1 ? 2 * (N - 2) * (N - 2) / (2.3 * N - 4.9) : 5 * N * N / (4 * m * (N + 3 * m));
}
inline double CalcEdfRandomWalk(std::size_t n, std::size_t cluster) {
  const double N = static_cast<double>(n + 1), m = static_cast<double>(cluster);
  return (N - 2) / m * ((N - 1) * (N - 1) - 3 * m * (N - 1) + 4 * m * m) / ((N - 3) * (N - 3));
}

}  // namespace piperun::testing
