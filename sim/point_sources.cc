#include "sim/point_sources.h"

#include <numbers>

namespace piperun::sim {
namespace {

constexpr std::size_t kLanes = 4;

}  // namespace

PointSources::PointSources(const std::vector<Vector3d>& places, const Eigen::MatrixXd& strengths)
    : patterns_(static_cast<std::size_t>(strengths.cols())) {
  const std::size_t groups = (places.size() + kLanes - 1) / kLanes;
  x_.resize(groups);
  y_.resize(groups);
  z_.resize(groups);
  strength_.assign(groups * patterns_, Lanes::Zero());
  for (std::size_t j = 0; j < groups * kLanes; ++j) {
    const std::size_t source = std::min(j, places.size() - 1);  // the last one, without strength, fills up
    const std::size_t group = j / kLanes;
    const auto lane = static_cast<Eigen::Index>(j % kLanes);
    x_[group][lane] = places[source].x();
    y_[group][lane] = places[source].y();
    z_[group][lane] = places[source].z();
    for (std::size_t i = 0; i < patterns_ && j < places.size(); ++i) {
      strength_[group * patterns_ + i][lane] =
          strengths(static_cast<Eigen::Index>(j), static_cast<Eigen::Index>(i)) / (4 * std::numbers::pi);
    }
  }
}

inline PointSources::Lanes PointSources::Strength(std::span<const double> weights, std::size_t group) const {
  Lanes q = weights[0] * strength_[group * patterns_];
  for (std::size_t i = 1; i < patterns_; ++i) q += weights[i] * strength_[group * patterns_ + i];
  return q;
}

VelocityGradient PointSources::Eval(std::span<const double> weights, const Vector3d& p) const {
  Lanes u = Lanes::Zero(), v = u, w = u, g0 = u, xx = u, yy = u, zz = u, xy = u, xz = u, yz = u;
  for (std::size_t g = 0; g < x_.size(); ++g) {
    const Lanes x = p.x() - x_[g], y = p.y() - y_[g], z = p.z() - z_[g];
    const Lanes i2 = (x * x + y * y + z * z).inverse();
    const Lanes a = Strength(weights, g) * i2 * i2.sqrt();
    const Lanes b = 3 * a * i2;
    const Lanes bx = b * x, by = b * y;
    u += a * x, v += a * y, w += a * z, g0 += a;
    xx += bx * x, yy += by * y, zz += b * z * z, xy += bx * y, xz += bx * z, yz += by * z;
  }
  const double a = g0.sum(), h_xy = -xy.sum(), h_xz = -xz.sum(), h_yz = -yz.sum();
  VelocityGradient result;
  result.velocity_m_s = {u.sum(), v.sum(), w.sum()};
  result.gradient_1_s << a - xx.sum(), h_xy, h_xz, h_xy, a - yy.sum(), h_yz, h_xz, h_yz, a - zz.sum();
  return result;
}

Vector3d PointSources::EvalVelocity(std::span<const double> weights, const Vector3d& p) const {
  Lanes u = Lanes::Zero(), v = u, w = u;
  for (std::size_t g = 0; g < x_.size(); ++g) {
    const Lanes x = p.x() - x_[g], y = p.y() - y_[g], z = p.z() - z_[g];
    const Lanes i2 = (x * x + y * y + z * z).inverse();
    const Lanes a = Strength(weights, g) * i2 * i2.sqrt();
    u += a * x, v += a * y, w += a * z;
  }
  return {u.sum(), v.sum(), w.sum()};
}

CrossPrimitive PointSources::EvalPrimitive(std::span<const double> weights, const Vector3d& p,
                                           const Matrix3d& axes, double z_turn) const {
  const double z_p = axes.col(2).dot(p);
  Lanes u = Lanes::Zero(), v = u, g0 = u, xx = u, xy = u, yy = u;
  for (std::size_t g = 0; g < x_.size(); ++g) {
    const Lanes dx = p.x() - x_[g], dy = p.y() - y_[g], dz = p.z() - z_[g];
    const Lanes x = axes(0, 0) * dx + axes(1, 0) * dy + axes(2, 0) * dz;
    const Lanes y = axes(0, 1) * dx + axes(1, 1) * dy + axes(2, 1) * dz;
    const Lanes z = axes(0, 2) * dx + axes(1, 2) * dy + axes(2, 2) * dz;
    const Lanes sigma = (z < z_p - z_turn).select(Lanes::Ones(), -Lanes::Ones());
    const Lanes r = (x * x + y * y + z * z).sqrt();
    const Lanes reach = r - sigma * z;
    const Lanes i = (r * reach).inverse();
    const Lanes a = sigma * Strength(weights, g) * i;
    const Lanes b = a * i * (1 + reach * reach * i);  // 1 + reach/r
    u += a * x, v += a * y, g0 += a;
    xx += b * x * x, xy += b * x * y, yy += b * y * y;
  }
  CrossPrimitive result;
  result.slope = {u.sum(), v.sum()};
  result.hessian << g0.sum() - xx.sum(), -xy.sum(), -xy.sum(), g0.sum() - yy.sum();
  return result;
}

}  // namespace piperun::sim
