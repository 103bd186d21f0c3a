#pragma once

#include <utility>

namespace piperun::sim {

/// One step of a damped oscillator that noise drives, solved exactly for constant coefficients:
///
///   dx = (omega y + P) dt,    dy = (-omega x - gamma y) dt + sqrt(2 gamma) dW
///
/// Without a push P, x and y are stationary at unit variance, independent of each other at one instant,
/// whatever the step. Integral time of x: gamma / omega^2; rms of dx/dt: omega. With gamma = 1/T1 + 1/T2 and
/// omega^2 = 1/(T1 T2) x is Sawford's second-order process (Phys. Fluids A 3, 1577 (1991)) of integral time
/// T1 + T2; with gamma << omega a narrow band around omega / (2 pi). For n1, n2 standard normal:
///
///   x' =  keep_x x + trade y + push_x P + noise_xy n1 + noise_x n2
///   y' = -trade x + keep_y y + push_y P + noise_y n1
///
/// The noise is that of the covariance 1 - A A^T, A the matrix of the four first factors, since the
/// stationary covariance is the unit matrix.
struct OscillatorStep {
  double keep_x = 1;
  double trade = 0;
  double keep_y = 1;
  double push_x_s = 0;
  double push_y_s = 0;
  double noise_x = 0;
  double noise_xy = 0;
  double noise_y = 0;

  /// x' and y' of one oscillator, or of as many as a vector has components.
  template <class T>
  std::pair<T, T> Advance(const T& x, const T& y, const T& push, const T& n1, const T& n2) const {
    return {keep_x * x + trade * y + push_x_s * push + noise_xy * n1 + noise_x * n2,
            keep_y * y - trade * x + push_y_s * push + noise_y * n1};
  }
};

/// Over- and underdamped alike. omega > 0, gamma > 0, dt > 0 (aborts otherwise).
OscillatorStep CalcOscillatorStep(double omega_1_s, double gamma_1_s, double dt_s);

}  // namespace piperun::sim
