#include "estimator/nonnegative_fit.h"

#include <Eigen/QR>
#include <vector>

#include "base/check.h"

namespace piperun::estimator {
namespace {

constexpr Eigen::Index kMostColumns = 10;

std::vector<Eigen::Index> ColumnsOf(unsigned subset, Eigen::Index columns) {
  std::vector<Eigen::Index> chosen;
  for (Eigen::Index j = 0; j < columns; ++j) {
    if ((subset >> j) & 1U) chosen.push_back(j);
  }
  return chosen;
}

}  // namespace

NonnegativeFit FitNonnegative(const Eigen::MatrixXd& A, const Eigen::VectorXd& b) {
  Demand(A.cols() <= kMostColumns, "too many columns to try all subsets");
  const Eigen::VectorXd norms = A.colwise().norm();
  NonnegativeFit best{Eigen::VectorXd::Zero(A.cols()), b.squaredNorm()};
  for (unsigned subset = 1; subset < (1U << A.cols()); ++subset) {
    const auto columns = ColumnsOf(subset, A.cols());
    if (static_cast<Eigen::Index>(columns.size()) > A.rows()) continue;
    const Eigen::MatrixXd part = A(Eigen::all, columns) * norms(columns).cwiseInverse().asDiagonal();
    const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(part);
    const Eigen::VectorXd scaled = qr.solve(b);
    if (qr.rank() < part.cols() || !(scaled.minCoeff() > 0)) continue;
    const double squared_residual = (part * scaled - b).squaredNorm();
    if (squared_residual >= best.squared_residual) continue;
    best = {Eigen::VectorXd::Zero(A.cols()), squared_residual};
    best.x(columns) = scaled.cwiseQuotient(norms(columns));
  }
  return best;
}

}  // namespace piperun::estimator
