#include "sim/feature_line.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace piperun::sim {
namespace {

constexpr double kAcross = 1e-9;  // 1 - cos between a foot's normal and the way to the axis

}  // namespace

void FeatureLine::Finish(double cell_m) {
  if (shapes_.empty()) return;
  std::stable_sort(shapes_.begin(), shapes_.end(),
                   [](const PlacedShape& a, const PlacedShape& b) { return a.begin_m < b.begin_m; });
  origin_m_ = shapes_.front().begin_m;
  cell_m_ = cell_m;
  double last_m = origin_m_;
  for (const PlacedShape& shape : shapes_) last_m = std::max(last_m, shape.end_m);
  const auto cells = static_cast<std::size_t>((last_m - origin_m_) / cell_m) + 2;
  std::size_t i = 0;
  for (std::size_t cell = 0; cell < cells; ++cell) {
    const double begin_m = origin_m_ + static_cast<double>(cell) * cell_m;
    while (i < shapes_.size() && shapes_[i].end_m < begin_m) ++i;
    first_.push_back(static_cast<std::uint32_t>(i));
  }
}

/// Shapes before this one end before a.
std::size_t FeatureLine::FindFirst(double a_m) const {
  const double cell = (a_m - origin_m_) / cell_m_;
  if (!(cell > 0)) return first_.front();
  return first_[std::min(static_cast<std::size_t>(cell), first_.size() - 1)];
}

bool FeatureLine::IsClear(double a_m, double b_m) const {
  if (shapes_.empty()) return true;
  for (std::size_t i = FindFirst(a_m); i < shapes_.size() && shapes_[i].begin_m <= b_m; ++i) {
    if (shapes_[i].end_m >= a_m) return false;
  }
  return true;
}

void FeatureLine::Apply(const PipePoint& p, const Vector3d& p_F, double limit_m, double ring_m,
                        WallFeet& feet) const {
  if (shapes_.empty()) return;
  const std::size_t first = FindFirst(p.s_m - limit_m);
  const double last_m = p.s_m + limit_m;
  for (std::size_t i = first; i < shapes_.size() && shapes_[i].begin_m <= last_m; ++i) {
    if (shapes_[i].begin_m <= p.s_m && shapes_[i].end_m >= p.s_m) feet = Recede(shapes_[i], p, p_F, feet);
  }
  for (std::size_t i = first; i < shapes_.size() && shapes_[i].begin_m <= last_m; ++i) {
    if (shapes_[i].end_m >= p.s_m - limit_m) AddFeet(shapes_[i], p_F, limit_m, ring_m, feet);
  }
}

WallFeet FeatureLine::Recede(const PlacedShape& placed, const PipePoint& p, const Vector3d& p_F,
                             const WallFeet& feet) {
  WallFeet left;
  for (const WallFoot& foot : feet) {
    const bool own_wall = foot.body < 0 && foot.feature < 0 && foot.normal.dot(p.out) < -1 + kAcross;
    const Vector3d q_F = p_F - foot.distance_m * foot.normal;
    const double recess_m =
        own_wall ? CalcRecess_m(*placed.shape, p.s_m - placed.s_m, placed.R_GF * (q_F - placed.p_FG)) : 0;
    if (recess_m == 0) left.Add(foot);
    if (recess_m > 0 && recess_m < std::numeric_limits<double>::infinity()) {
      left.Add({foot.normal, foot.distance_m + recess_m, foot.kind, placed.feature, placed.body});
    }
  }
  return left;
}

void FeatureLine::AddFeet(const PlacedShape& placed, const Vector3d& p_F, double limit_m, double ring_m,
                          WallFeet& feet) {
  WallFeet found;
  AddBodyFeet(*placed.shape, placed.R_GF * (p_F - placed.p_FG), limit_m, ring_m, found);
  const int body = IsEdgeOfWall(*placed.shape) ? -1 : placed.body;
  for (const WallFoot& foot : found) {
    if (foot.distance_m > limit_m) continue;
    feet.Add({placed.R_GF.transpose() * foot.normal, foot.distance_m, foot.kind, placed.feature, body});
  }
}

}  // namespace piperun::sim
