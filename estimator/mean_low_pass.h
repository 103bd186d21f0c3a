#pragma once

#include <Eigen/Core>
#include <cmath>

namespace piperun::estimator {

/// Second-order Butterworth low pass of a vector, tau^2 y'' + 2 tau y' + 2 y = 2 u, for steps of any length:
/// the exact solution for an input that is constant over each. Its corner is sqrt(2) / (2 pi tau). During the
/// first tau it gives the mean so far, and goes on from there at rest (D. Laidig & T. Seel, Information
/// Fusion 91, 187, 2023, section 3.2). A value: copy it to save its state.
template <int n>
class MeanLowPass {
 public:
  using Vector = Eigen::Matrix<double, n, 1>;

  explicit MeanLowPass(double tau_s) : tau_s_(tau_s) {}

  const Vector& Step(const Vector& u, double dt_s) {
    if (elapsed_s_ < tau_s_) {
      elapsed_s_ += dt_s;
      y_ += (dt_s / elapsed_s_) * (u - y_);
      return y_;
    }
    if (dt_s != dt_s_) Discretise(dt_s);
    const Vector off = y_ - u;
    y_ = u + a_ * off + b_ * dy_;
    dy_ = c_ * off + d_ * dy_;
    return y_;
  }
  const Vector& value() const { return y_; }

 private:
  void Discretise(double dt_s) {
    const double x = dt_s / tau_s_, decay = std::exp(-x), c = std::cos(x), s = std::sin(x);
    dt_s_ = dt_s;
    a_ = decay * (c + s);
    b_ = decay * s * tau_s_;
    c_ = -2 * decay * s / tau_s_;
    d_ = decay * (c - s);
  }

  double tau_s_;
  double elapsed_s_ = 0;
  double dt_s_ = 0, a_ = 0, b_ = 0, c_ = 0, d_ = 0;
  Vector y_ = Vector::Zero(), dy_ = Vector::Zero();
};

}  // namespace piperun::estimator
