#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

#include "base/pose.h"

namespace piperun::testing {

/// The union of half-tubes that begin at nodes and of the nodes' spheres, looked at along rays. Shares
/// nothing with the walls under test: it knows inside and outside only, not walls and edges.
struct UnionOfBores {
  struct Tube {
    Vector3d axis;
    double radius_m = 0;
    Vector3d node = Vector3d::Zero();
  };
  std::vector<Tube> tubes;

  double SphereRadius_m() const {
    double radius_m = 0;
    for (const Tube& tube : tubes) radius_m = std::max(radius_m, tube.node.isZero() ? tube.radius_m : 0);
    return radius_m;
  }

  bool Contains(const Vector3d& p) const {
    if (p.norm() < SphereRadius_m()) return true;
    return std::any_of(tubes.begin(), tubes.end(), [&](const Tube& tube) {
      const Vector3d d = p - tube.node;
      return d.dot(tube.axis) >= 0 && d.cross(tube.axis).norm() < tube.radius_m;
    });
  }

  /// q lies on the boundary, within `slack_m`: both kinds of points are that near.
  bool IsOnBoundary(const Vector3d& q, double slack_m) const {
    bool inside = false, outside = false;
    for (int i = 0; i < 27; ++i) {
      const Vector3d d(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1);
      (Contains(q + slack_m * d) ? inside : outside) = true;
    }
    return inside && outside;
  }

  /// How far one can go from p, which lies inside, before leaving the union.
  double CalcExit(const Vector3d& p, const Vector3d& u) const {
    std::array<std::pair<double, double>, 8> all;
    const std::span stretches(all.data(), tubes.size() + 1);
    all[0] = Stretch(p.dot(u), p.squaredNorm(), SphereRadius_m());
    for (std::size_t i = 0; i < tubes.size(); ++i) all[i + 1] = StretchIn(tubes[i], p - tubes[i].node, u);
    std::sort(stretches.begin(), stretches.end());
    double reached = 0;
    for (const auto& [first, last] : stretches) {
      if (first <= reached + 1e-13) reached = std::max(reached, last);
    }
    return reached;
  }

  /// Least exit over all directions: rays all around, the best of them refined by smaller and smaller turns.
  /// Never below the distance to the boundary; above it by micrometres where turns get stuck in an edge.
  double CalcDistance(const Vector3d& p) const {
    constexpr int kRays = 1500, kBest = 4;
    std::vector<std::pair<double, Vector3d>> best;
    for (int i = 0; i < kRays; ++i) {
      const double z = 1 - (2 * i + 1.0) / kRays, angle = i * std::numbers::pi * (3 - std::sqrt(5.0));
      const double rho = std::sqrt(1 - z * z);
      const Vector3d u(rho * std::cos(angle), rho * std::sin(angle), z);
      best.emplace_back(CalcExit(p, u), u);
    }
    std::partial_sort(best.begin(), best.begin() + kBest, best.end(),
                      [](const auto& a, const auto& b) { return a.first < b.first; });
    double least = best.front().first;
    for (int i = 0; i < kBest; ++i)
      least = std::min(least, Refine(p, best[static_cast<std::size_t>(i)].second));
    return least;
  }

 private:
  /// Where |p + t u| < radius, from p.u and p.p for a unit vector u.
  static std::pair<double, double> Stretch(double along, double square, double radius_m) {
    const double h = along * along - square + radius_m * radius_m;
    if (h <= 0) return {1e9, -1e9};
    return {-along - std::sqrt(h), -along + std::sqrt(h)};
  }

  static std::pair<double, double> StretchIn(const Tube& tube, const Vector3d& p, const Vector3d& u) {
    const Vector3d across_p = p.cross(tube.axis), across_u = u.cross(tube.axis);
    const double sine = across_u.norm(), slope = u.dot(tube.axis), begin = p.dot(tube.axis);
    std::pair<double, double> in{-1e9, 1e9};
    if (sine > 1e-12) {
      in = Stretch(across_p.dot(across_u) / sine, across_p.squaredNorm(), tube.radius_m);
      in = {in.first / sine, in.second / sine};
    } else if (across_p.norm() > tube.radius_m) {
      return {1e9, -1e9};
    }
    if (slope > 1e-12) in.first = std::max(in.first, -begin / slope);
    if (slope < -1e-12) in.second = std::min(in.second, -begin / slope);
    return in.first < in.second ? in : std::pair{1e9, -1e9};
  }

  double Refine(const Vector3d& p, Vector3d u) const {
    double least = CalcExit(p, u);
    for (double turn = 0.05; turn > 1e-8;) {
      const Vector3d a = u.unitOrthogonal(), b = u.cross(a);
      bool better = false;
      for (int k = 0; k < 8; ++k) {
        const double angle = 2 * std::numbers::pi * k / 8;
        const Vector3d v = (u + turn * (std::cos(angle) * a + std::sin(angle) * b)).normalized();
        const double exit = CalcExit(p, v);
        if (exit >= least) continue;
        least = exit;
        u = v;
        better = true;
      }
      if (!better) turn *= 0.5;
    }
    return least;
  }
};

}  // namespace piperun::testing
