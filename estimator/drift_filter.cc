#include "estimator/drift_filter.h"

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <cmath>

namespace piperun::estimator {
namespace {

double Matern(double distance_m, double length_m) {
  const double u = std::sqrt(3.0) * std::abs(distance_m) / length_m;
  return (1 + u) * std::exp(-u);
}

/// Of the window's levels, band first, then reference.
Eigen::MatrixXd CalcCovariance(const LevelModel& model, Eigen::Index bins, double bin_m,
                               double frames_per_bin) {
  const double common = model.common_drift_dB * model.common_drift_dB;
  const double own = model.own_drift_dB * model.own_drift_dB;
  Eigen::MatrixXd C(2 * bins, 2 * bins);
  for (Eigen::Index i = 0; i < bins; ++i) {
    for (Eigen::Index j = 0; j < bins; ++j) {
      const double k = Matern(static_cast<double>(i - j) * bin_m, model.drift_length_m);
      C(i, j) = C(bins + i, bins + j) = (common + own) * k;
      C(i, bins + j) = C(bins + i, j) = common * k;
    }
    C(i, i) += model.band_scatter_dB * model.band_scatter_dB / frames_per_bin;
    C(bins + i, bins + i) += model.reference_scatter_dB * model.reference_scatter_dB / frames_per_bin;
  }
  return C;
}

/// Constant and trend of each band.
Eigen::MatrixXd MakeNuisances(Eigen::Index bins) {
  Eigen::MatrixXd H = Eigen::MatrixXd::Zero(2 * bins, 4);
  for (Eigen::Index i = 0; i < bins; ++i) {
    H(i, 0) = H(bins + i, 2) = 1;
    H(i, 1) = H(bins + i, 3) = static_cast<double>(2 * i) / static_cast<double>(bins - 1) - 1;
  }
  return H;
}

}  // namespace

DriftFilter::DriftFilter(const LevelModel& model, const std::vector<Roof>& roofs, const Window& window) {
  const Eigen::Index bins = window.behind + window.ahead + 1, all = 2 * window.half + 1;
  const Eigen::LLT<Eigen::MatrixXd> llt(CalcCovariance(model, bins, window.bin_m, window.frames_per_bin));
  const Eigen::MatrixXd whitened_H = llt.matrixL().solve(MakeNuisances(bins));
  const Eigen::MatrixXd Q = Eigen::HouseholderQR<Eigen::MatrixXd>(whitened_H).householderQ() *
                            Eigen::MatrixXd::Identity(2 * bins, 4);
  weights_.setZero(2 * all, static_cast<Eigen::Index>(roofs.size()));
  for (std::size_t r = 0; r < roofs.size(); ++r) {
    Eigen::VectorXd m = Eigen::VectorXd::Zero(2 * bins);
    for (Eigen::Index i = 0; i < bins; ++i)
      m[i] = roofs[r].Level_dB(static_cast<double>(i - window.behind) * window.bin_m);
    Eigen::VectorXd whitened = llt.matrixL().solve(m);
    whitened -= Q * (Q.transpose() * whitened);
    unit_amplitude_.push_back(1 / whitened.norm());
    const Eigen::VectorXd w = llt.matrixL().transpose().solve(whitened) * unit_amplitude_.back();
    auto column = weights_.col(static_cast<Eigen::Index>(r));
    column.segment(window.half - window.behind, bins) = w.head(bins);
    column.segment(all + window.half - window.behind, bins) = w.tail(bins);
  }
}

}  // namespace piperun::estimator
