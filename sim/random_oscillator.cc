#include "sim/random_oscillator.h"

#include <cmath>

#include "base/check.h"

namespace piperun::sim {
namespace {

/// phi solves phi'' + gamma phi' + omega^2 phi = 0, phi(0) = 0, phi'(0) = 1; exp(A h) is made of it and of
/// phi'.
struct Response {
  double phi_s = 0;
  double slope = 0;
};

Response CalcResponse(double omega_1_s, double gamma_1_s, double dt_s) {
  const double half = 0.5 * gamma_1_s, discriminant = half * half - omega_1_s * omega_1_s;
  const double root = std::sqrt(std::abs(discriminant));
  if (root * dt_s < 1e-9) {
    const double decay = std::exp(-half * dt_s);
    return {dt_s * decay, decay * (1 - half * dt_s)};
  }
  if (discriminant < 0) {
    const double decay = std::exp(-half * dt_s), phi_s = decay * std::sin(root * dt_s) / root;
    return {phi_s, decay * std::cos(root * dt_s) - half * phi_s};
  }
  const double fast = half + root, slow = omega_1_s * omega_1_s / fast;
  const double decay = std::exp(-slow * dt_s), phi_s = decay * -std::expm1(-2 * root * dt_s) / (2 * root);
  return {phi_s, decay - fast * phi_s};
}

/// What rounding would eat in a short step.
struct Cancelling {
  double variance_x = 0;  ///< 2 gamma omega^2 integral of phi^2
  double push_y_s = 0;    ///< -omega integral of phi
};

/// By the series of phi.
Cancelling ExpandShortStep(double omega_1_s, double gamma_1_s, double dt_s) {
  const double g = gamma_1_s * dt_s, w = omega_1_s * dt_s;
  return {2 * g * w * w * (1.0 / 3 - g / 4 + (7 * g * g - 4 * w * w) / 60),
          -w * dt_s * (0.5 - g / 6 + (g * g - w * w) / 24)};
}

}  // namespace

OscillatorStep CalcOscillatorStep(double omega_1_s, double gamma_1_s, double dt_s) {
  Demand(omega_1_s > 0 && gamma_1_s > 0 && dt_s > 0, "an oscillator swings, is damped and moves on");
  const Response response = CalcResponse(omega_1_s, gamma_1_s, dt_s);
  const double phi_s = response.phi_s;
  OscillatorStep step;
  step.keep_x = response.slope + gamma_1_s * phi_s;
  step.trade = omega_1_s * phi_s;
  step.keep_y = response.slope;
  const bool is_short = (omega_1_s + gamma_1_s) * dt_s < 0.01;
  const Cancelling closed{1 - step.keep_x * step.keep_x - step.trade * step.trade,
                          (step.keep_x - 1) / omega_1_s};
  const Cancelling fine = is_short ? ExpandShortStep(omega_1_s, gamma_1_s, dt_s) : closed;
  step.push_y_s = fine.push_y_s;
  step.push_x_s = (step.trade - gamma_1_s * step.push_y_s) / omega_1_s;
  const double variance_y = 1 - step.trade * step.trade - step.keep_y * step.keep_y;
  step.noise_y = std::sqrt(variance_y);
  step.noise_xy = omega_1_s * gamma_1_s * phi_s * phi_s / step.noise_y;
  step.noise_x = std::sqrt(fine.variance_x - step.noise_xy * step.noise_xy);
  return step;
}

}  // namespace piperun::sim
