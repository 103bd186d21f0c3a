#include "sim/bore_member.h"

#include <algorithm>
#include <cmath>

namespace piperun::sim {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kOnAxis_m = 1e-9;
constexpr double kParallel = 1e-20;  // sin^2 of the angle between

/// A point relative to a member: along its axis (0 for a sphere), and away from the axis or centre.
struct Local {
  double along = 0;
  Vector3d off;
};

Local ToLocal(const BoreMember& member, const Vector3d& vector) {
  const double along = vector.dot(member.axis);
  return {along, vector - along * member.axis};
}

/// The range of t in which something holds along a line.
struct Range {
  double first = -kInfinity, last = kInfinity;
};

constexpr Range kNowhere{kInfinity, -kInfinity};

/// |off + t direction| <= radius.
Range WithinRadius(const Vector3d& off, const Vector3d& direction, double radius_m) {
  const double a = direction.squaredNorm(), b = off.dot(direction),
               c = off.squaredNorm() - radius_m * radius_m;
  if (a < kParallel) return c > 0 ? kNowhere : Range{};
  const double discriminant = b * b - a * c;
  if (discriminant < 0) return kNowhere;
  const double root = std::sqrt(discriminant);
  return {(-b - root) / a, (-b + root) / a};
}

/// 0 <= along + t slope <= length.
Range WithinEnds(double along, double slope, double length_m) {
  if (slope * slope < kParallel) return along >= 0 && along <= length_m ? Range{} : kNowhere;
  const double at_begin = -along / slope, at_end = (length_m - along) / slope;
  return {std::min(at_begin, at_end), std::max(at_begin, at_end)};
}

}  // namespace

double CalcDepth(const BoreMember& member, const Vector3d& p_N) {
  const Local p = ToLocal(member, p_N - member.origin);
  const double inside = member.radius_m - p.off.norm();
  return member.sphere() ? inside : std::min({inside, p.along, member.length_m - p.along});
}

Vector3d CalcDeepening(const BoreMember& member, const Vector3d& p_N) {
  const Local p = ToLocal(member, p_N - member.origin);
  const double inside = member.radius_m - p.off.norm();
  if (member.sphere() || inside <= std::min(p.along, member.length_m - p.along)) return -p.off.normalized();
  return p.along < member.length_m - p.along ? member.axis : Vector3d(-member.axis);
}

Vector3d CalcWallNormal(const BoreMember& member, const Vector3d& p_N) {
  return -ToLocal(member, p_N - member.origin).off.normalized();
}

bool FindWallFoot(const BoreMember& member, const Vector3d& p_N, WallFoot& foot) {
  const Local p = ToLocal(member, p_N - member.origin);
  const double rho = p.off.norm();
  if (rho > member.radius_m || rho < kOnAxis_m || p.along < 0 || p.along > member.length_m) return false;
  foot = {-p.off / rho, member.radius_m - rho, WallFoot::Kind::kSheet};
  return true;
}

double CalcExit(const BoreMember& member, const Vector3d& begin_N, const Vector3d& direction) {
  const Local p = ToLocal(member, begin_N - member.origin), d = ToLocal(member, direction);
  Range range = WithinRadius(p.off, d.off, member.radius_m);
  if (!member.sphere()) {
    const Range ends = WithinEnds(p.along, d.along, member.length_m);
    range = {std::max(range.first, ends.first), std::min(range.last, ends.last)};
  }
  return range.first <= range.last ? range.last : -kInfinity;
}

}  // namespace piperun::sim
