#include "sim/bore_profile.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace piperun::sim {
namespace {

constexpr double kSlack_m = 1e-12;  // feet of neighbouring walls overlap by this much

/// `out` turned around the axis by k times 120 degrees.
Vector3d TurnOut(const PipePoint& p, int k) {
  const double angle = 2 * std::numbers::pi / 3 * k;
  return std::cos(angle) * p.out + std::sin(angle) * p.tangent.cross(p.out);
}

}  // namespace

BoreProfile::BoreProfile(const Bore& bore, int pipe) {
  const Pipe& p = bore.network().pipe(pipe);
  if (p.cone_from.length_m > 0) vertices_.push_back({0, p.cone_from.end_radius_m});
  vertices_.push_back({p.cone_from.length_m, p.radius_m()});
  const double cone_to_m = p.length_m - p.cone_to.length_m;
  if (cone_to_m > p.cone_from.length_m) vertices_.push_back({cone_to_m, p.radius_m()});
  if (p.cone_to.length_m > 0) vertices_.push_back({p.length_m, p.cone_to.end_radius_m});
  AddNeighbour(bore, pipe, false);
  AddNeighbour(bore, pipe, true);
}

/// Goes on into the pipe behind a smooth joint: its nearer cone, and the cylinder behind.
void BoreProfile::AddNeighbour(const Bore& bore, int pipe, bool at_to) {
  if (!bore.open(pipe)) return;
  const Pipe& p = bore.network().pipe(pipe);
  const Joint& joint = bore.joint(at_to ? p.to : p.from);
  if (!joint.smooth) return;
  (at_to ? open_end_ : open_begin_) = true;
  const PipeEnd mine{pipe, at_to};
  const PipeEnd other = joint.arms[joint.arms[0].end == mine ? 1 : 0].end;
  const Pipe& next = bore.network().pipe(other.pipe);
  const Cone& cone = other.at_to ? next.cone_to : next.cone_from;
  const double sign = at_to ? 1 : -1, end_m = at_to ? p.length_m : 0;
  const auto add = [&](double beyond_m, double radius_m) {
    vertices_.insert(at_to ? vertices_.end() : vertices_.begin(), {end_m + sign * beyond_m, radius_m});
  };
  if (cone.length_m > 0) add(cone.length_m, next.radius_m());
  add(std::max(next.length_m, cone.length_m + next.radius_m()), next.radius_m());
}

bool BoreProfile::IsUniform(double a_m, double b_m) const {
  if ((!open_begin_ && a_m < vertices_.front().s_m) || (!open_end_ && b_m > vertices_.back().s_m))
    return false;
  for (std::size_t i = 0; i + 1 < vertices_.size(); ++i) {
    const bool meets = vertices_[i].s_m < b_m && vertices_[i + 1].s_m > a_m;
    if (meets && vertices_[i].radius_m != vertices_[i + 1].radius_m) return false;
  }
  return true;
}

double BoreProfile::Slope(std::size_t segment) const {
  const Vertex &a = vertices_[segment], &b = vertices_[segment + 1];
  return (b.radius_m - a.radius_m) / (b.s_m - a.s_m);
}

bool BoreProfile::Holds(std::size_t segment, double s_m) const {
  const bool after = s_m >= vertices_[segment].s_m - kSlack_m || (segment == 0 && open_begin_);
  const bool before =
      s_m <= vertices_[segment + 1].s_m + kSlack_m || (segment + 2 == vertices_.size() && open_end_);
  return after && before;
}

void BoreProfile::AddSegmentFeet(const PipePoint& p, std::size_t segment, double ring_m,
                                 WallFeet& feet) const {
  const double m = Slope(segment), cosine = 1 / std::sqrt(1 + m * m);
  const double radius_m = vertices_[segment].radius_m + m * (p.s_m - vertices_[segment].s_m);
  const double distance_m = cosine * (radius_m - p.offset_m);
  if (!Holds(segment, p.s_m - cosine * m * distance_m)) return;
  feet.Add({cosine * (m * p.tangent - p.out), distance_m, WallFoot::Kind::kSheet});
  if (m == 0 || cosine * 2 * p.offset_m > ring_m) return;
  for (const int k : {1, 2}) {
    const double opposite_m = cosine * (radius_m + 0.5 * p.offset_m);  // cos 120 = -1/2
    feet.Add({cosine * (m * p.tangent - TurnOut(p, k)), opposite_m, WallFoot::Kind::kPlane});
  }
}

void BoreProfile::AddEdgeFeet(const PipePoint& p, std::size_t vertex, double ring_m, WallFeet& feet) const {
  const Vertex& edge = vertices_[vertex];
  const double before = Slope(vertex - 1), after = Slope(vertex);
  const double ds = p.s_m - edge.s_m, depth = edge.radius_m - p.offset_m;
  if (after <= before || depth <= 0) return;
  // in the normal cone: between (before, -1) and (after, -1)
  if (ds < before * depth - kSlack_m || ds > after * depth + kSlack_m) return;
  const double distance_m = std::hypot(ds, depth);
  feet.Add({(ds * p.tangent - depth * p.out) / distance_m, distance_m, WallFoot::Kind::kSheet});
  if (2 * p.offset_m > ring_m) return;
  for (const int k : {1, 2}) {
    const Vector3d d = ds * p.tangent + p.offset_m * p.out - edge.radius_m * TurnOut(p, k);
    feet.Add({d.normalized(), d.norm(), WallFoot::Kind::kPoint});
  }
}

void BoreProfile::AddFeet(const PipePoint& p, double limit_m, double ring_m, WallFeet& feet) const {
  for (std::size_t i = 0; i + 1 < vertices_.size(); ++i) {
    const bool begins = vertices_[i].s_m <= p.s_m + limit_m || i == 0;
    const bool ends = vertices_[i + 1].s_m >= p.s_m - limit_m || i + 2 == vertices_.size();
    if (!begins || !ends) continue;
    AddSegmentFeet(p, i, ring_m, feet);
    if (i > 0) AddEdgeFeet(p, i, ring_m, feet);
  }
}

}  // namespace piperun::sim
