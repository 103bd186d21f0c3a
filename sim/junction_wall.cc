#include "sim/junction_wall.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace piperun::sim {
namespace {

using std::numbers::pi;

// lengths in radii of the bore at hand, for joints of ordinary size
constexpr double kSourceOffset = 0.5;
constexpr double kSourceSpacing = 0.6;
constexpr double kWallSpacing = 0.26;
constexpr double kOrdinaryArea = 75;  // of the tubes, each in squares of its own radius
constexpr int kSectionAngles = 24;
constexpr int kLipAngles = 28;
constexpr std::array<double, 2> kLipOffset{0.12, 0.3};  // of the sources behind a right-angled lip
constexpr double kLipTurn = 0.55;  // their angle from the bisector, in half angles of the wedge
constexpr double kLeastLip = 0.3;  // walls that meet flatter or sharper (of two unit normals) make no lip
constexpr std::array<double, 5> kGaussPoint{0.04691007703066802, 0.23076534494715845, 0.5, 0.7692346550528415,
                                            0.953089922969332};
constexpr std::array<double, 5> kGaussWeight{0.11846344252809454, 0.23931433524968324, 0.28444444444444444,
                                             0.23931433524968324, 0.11846344252809454};

/// Signed distance from a tube with flat ends that begins at the node; negative inside.
double CalcTubeDistance(const JointArm& arm, double length_m, const Vector3d& p) {
  const double along = p.dot(arm.outward);
  const double beside = (p - along * arm.outward).norm() - arm.radius_m;
  const double beyond = std::max(-along, along - length_m);
  return std::min(std::max(beside, beyond), 0.0) + std::hypot(std::max(beside, 0.0), std::max(beyond, 0.0));
}

/// A frame whose z is `axis` and whose x leans towards `side`.
Matrix3d MakeAxes(const Vector3d& axis, const Vector3d& side) {
  const Vector3d across = side - side.dot(axis) * axis;
  Matrix3d axes;
  axes.col(2) = axis;
  axes.col(0) = across.norm() > 1e-3 * side.norm() ? Vector3d(across.normalized()) : axis.unitOrthogonal();
  axes.col(1) = axes.col(2).cross(axes.col(0));
  return axes;
}

class Builder {
 public:
  Builder(const Joint& joint, std::span<const double> core_m) : joint_(joint), core_m_(core_m) {
    double area = 0;
    for (std::size_t i = 0; i < joint.arms.size(); ++i) area += 2 * pi * core_m[i] / joint.arms[i].radius_m;
    coarseness_ = std::sqrt(std::max(1.0, area / kOrdinaryArea));
  }

  JunctionWall Build() {
    for (std::size_t i = 0; i < joint_.arms.size(); ++i) {
      AddTube(i);
      AddSection(i);
      AddTubeSources(i);
      AddLipSources(i);
    }
    AddSphere(joint_.sphere_radius_m, kWallSpacing, [&](const WallPoint& point) {
      if (Distance(point.p_N, -1, false) >= 0) result_.wall.push_back(point);
    });
    const double offset = Offset(joint_.sphere_radius_m);
    AddSphere(joint_.sphere_radius_m + offset, kSourceSpacing,
              [&](const WallPoint& point) { AddSource(point.p_N, offset); });
    return std::move(result_);
  }

 private:
  double Offset(double radius_m) const { return kSourceOffset * coarseness_ * radius_m; }

  /// From the water, but for one arm's and the sphere's if so wanted.
  double Distance(const Vector3d& p, int without_arm, bool sphere) const {
    double distance = sphere ? p.norm() - joint_.sphere_radius_m : std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < joint_.arms.size(); ++i) {
      if (static_cast<int>(i) == without_arm) continue;
      distance = std::min(distance, CalcTubeDistance(joint_.arms[i], core_m_[i], p));
    }
    return distance;
  }

  void AddSource(const Vector3d& p, double offset) {
    if (Distance(p, -1, true) >= 0.9 * offset) result_.sources.push_back(p);
  }

  /// Calls f(point on a circle around the arm's axis, its outward direction) at equal angles.
  template <class F>
  void ForRing(const Matrix3d& axes, double z, double radius_m, int count, F f) const {
    for (int k = 0; k < count; ++k) {
      const double angle = 2 * pi * k / count;
      const Vector3d out = std::cos(angle) * axes.col(0) + std::sin(angle) * axes.col(1);
      f(z * axes.col(2) + radius_m * out, out);
    }
  }

  /// A multiple of four, so that a ring is symmetric in both its axes.
  static int CountAround(double circumference, double spacing) {
    return std::max(4, 4 * static_cast<int>(std::lround(circumference / spacing / 4)));
  }

  void AddTube(std::size_t i) {
    const double radius = joint_.arms[i].radius_m, spacing = kWallSpacing * coarseness_ * radius;
    const int rings = std::max(1, static_cast<int>(std::ceil(core_m_[i] / spacing)));
    const int count = CountAround(2 * pi * radius, spacing);
    const double dz = core_m_[i] / rings, area = dz * 2 * pi * radius / count;
    const Matrix3d axes = MakeArmAxes(joint_, i);
    for (int k = 0; k < rings; ++k) {
      ForRing(axes, (k + 0.5) * dz, radius, count, [&](const Vector3d& p, const Vector3d& out) {
        if (Distance(p, static_cast<int>(i), true) >= 0) result_.wall.push_back({p, out, area});
      });
    }
  }

  void AddSection(std::size_t i) {
    const double radius = joint_.arms[i].radius_m;
    const Matrix3d axes = MakeArmAxes(joint_, i);
    std::vector<WallPoint> section;
    for (std::size_t k = 0; k < kGaussPoint.size(); ++k) {
      const double r = radius * kGaussPoint[k];
      const double area = 2 * pi * r * radius * kGaussWeight[k] / kSectionAngles;
      ForRing(axes, core_m_[i], r, kSectionAngles, [&](const Vector3d& p, const Vector3d&) {
        section.push_back({p, axes.col(2), area});
      });
    }
    result_.sections.push_back(std::move(section));
  }

  void AddTubeSources(std::size_t i) {
    const double radius = joint_.arms[i].radius_m, offset = Offset(radius);
    const double spacing = kSourceSpacing * coarseness_ * radius, end = core_m_[i] + offset;
    const Matrix3d axes = MakeArmAxes(joint_, i);
    const auto add = [&](const Vector3d& p, const Vector3d&) { AddSource(p, offset); };
    const int rings = std::max(1, static_cast<int>(std::ceil(end / spacing)));
    const int count = CountAround(2 * pi * (radius + offset), 1.4 * spacing);
    for (int k = 0; k <= rings; ++k) ForRing(axes, end * k / rings, radius + offset, count, add);
    AddSource(end * axes.col(2), offset);
    for (const double part : {0.45, 0.9}) {
      const double r = part * radius;
      ForRing(axes, end, r, CountAround(2 * pi * r, 1.4 * spacing), add);
    }
  }

  /// Where the tube comes out of the rest of the water along the line (angle) of its wall; negative: nowhere.
  double FindLip_m(int arm, const Vector3d& on_ring) const {
    const Vector3d& axis = joint_.arms[static_cast<std::size_t>(arm)].outward;
    const auto outside = [&](double z) { return Distance(on_ring + z * axis, arm, true) > 0; };
    double inner = 0, outer = core_m_[static_cast<std::size_t>(arm)];
    if (outside(inner) || !outside(outer)) return -1;
    for (int k = 0; k < 40; ++k) {
      const double mid = 0.5 * (inner + outer);
      (outside(mid) ? outer : inner) = mid;
    }
    return outer;
  }

  Vector3d CalcDistanceGradient(int without_arm, const Vector3d& p) const {
    const double step = 1e-4 * joint_.sphere_radius_m;
    Vector3d gradient;
    for (int k = 0; k < 3; ++k) {
      const Vector3d d = step * Vector3d::Unit(k);
      gradient[k] = (Distance(p + d, without_arm, true) - Distance(p - d, without_arm, true)) / (2 * step);
    }
    return gradient;
  }

  /// The water turns sharply about the lip where a tube opens into the rest: sources right behind it, on
  /// either side of the bisector (on it they could not make the flow turn from one wall to the other).
  void AddLipSources(std::size_t i) {
    const JointArm& arm = joint_.arms[i];
    const int index = static_cast<int>(i);
    ForRing(MakeArmAxes(joint_, i), 0, arm.radius_m, kLipAngles, [&](const Vector3d& p, const Vector3d& out) {
      const double z = FindLip_m(index, p);
      if (z < 0) return;
      const Vector3d lip = p + z * arm.outward;
      const Vector3d other = CalcDistanceGradient(index, lip), bisector = out + other, across = out - other;
      if (across.norm() < kLeastLip || bisector.norm() < kLeastLip) return;
      const double half_wedge = std::asin(0.5 * bisector.norm()), turn = std::tan(kLipTurn * half_wedge);
      const double deeper = std::min(2.5, std::numbers::sqrt2 / bisector.norm());
      for (const double part : kLipOffset) {
        const double offset = deeper * part * arm.radius_m;
        for (const double side : {-turn, turn}) {
          const Vector3d towards = bisector.normalized() + side * across.normalized();
          AddLipSource(lip + offset * towards.normalized(), 0.2 * half_wedge * offset);
        }
      }
    });
  }

  void AddLipSource(const Vector3d& p, double least_m) {
    const auto same = [&](const Vector3d& source) { return (source - p).norm() < 0.1 * least_m; };
    if (Distance(p, -1, true) < least_m) return;
    if (std::none_of(result_.sources.begin(), result_.sources.end(), same)) result_.sources.push_back(p);
  }

  /// Calls f(point on the sphere with its outward normal), ring after ring about the normal of the arms'
  /// plane.
  template <class F>
  void AddSphere(double radius_m, double spacing_in_radii, F f) const {
    Vector3d sum = Vector3d::Zero(), across = Vector3d::Zero();
    for (const JointArm& arm : joint_.arms) {
      sum += arm.radius_m * arm.radius_m * arm.outward;
      if (across.norm() < 0.1) across = joint_.arms[0].outward.cross(arm.outward);
    }
    const double unit = joint_.sphere_radius_m * joint_.sphere_radius_m;
    const Vector3d side = sum.norm() > 1e-3 * unit ? sum : joint_.arms[0].outward;
    const Vector3d axis =
        across.norm() < 0.1 ? Vector3d(side.unitOrthogonal()) : Vector3d(across.normalized());
    const Matrix3d axes = MakeAxes(axis, side);
    const double spacing = spacing_in_radii * coarseness_ * joint_.sphere_radius_m;
    const int rings = std::max(2, static_cast<int>(std::lround(pi * radius_m / spacing)));
    for (int k = 0; k < rings; ++k) {
      const double polar = pi * (k + 0.5) / rings, r = radius_m * std::sin(polar);
      const int count = CountAround(2 * pi * r, spacing);
      const double area = 2 * pi * radius_m * r * (pi / rings) / count;
      ForRing(axes, radius_m * std::cos(polar), r, count, [&](const Vector3d& p, const Vector3d&) {
        f(WallPoint{p, p.normalized(), area});
      });
    }
  }

  const Joint& joint_;
  std::span<const double> core_m_;
  double coarseness_ = 1;  ///< large joints get larger patches, so that their cost stays bounded
  JunctionWall result_;
};

}  // namespace

Matrix3d MakeArmAxes(const Joint& joint, std::size_t arm) {
  const Vector3d axis = joint.arms[arm].outward;
  Vector3d side = Vector3d::Zero();
  for (const JointArm& other : joint.arms) side += other.outward - other.outward.dot(axis) * axis;
  for (const JointArm& other : joint.arms) {
    if (side.norm() > 1e-3) break;
    side = other.outward - other.outward.dot(axis) * axis;
  }
  return MakeAxes(axis, side.norm() > 1e-3 ? side : axis.unitOrthogonal());
}

JunctionWall MakeJunctionWall(const Joint& joint, std::span<const double> core_m) {
  return Builder(joint, core_m).Build();
}

}  // namespace piperun::sim
