#pragma once

#include <Eigen/Core>

namespace piperun::estimator {

struct NonnegativeFit {
  Eigen::VectorXd x;
  double squared_residual = 0;
};

/// min |A x - b|^2 over x >= 0, exactly: the best among the least-squares solutions of every subset of the
/// columns that come out positive (Lawson & Hanson, Solving Least Squares Problems, chapter 23, where the
/// solution is shown to be one of them). Range: up to ten columns.
NonnegativeFit FitNonnegative(const Eigen::MatrixXd& A, const Eigen::VectorXd& b);

}  // namespace piperun::estimator
