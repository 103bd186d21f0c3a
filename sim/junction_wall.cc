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
constexpr double kSourceOffset = 0.45;
constexpr double kSourceSpacing = 0.5;
constexpr double kFillet = 0.8;       // width of the rounding of a right-angled lip
constexpr double kPatchArea = 0.5;    // largest, in squares of the distance from the nearest source
constexpr int kFinest = 3;            // times a patch may be halved
constexpr double kOrdinaryArea = 75;  // of the tubes, each in squares of its own radius
constexpr int kSectionAngles = 24;
constexpr int kSections = 3;
constexpr std::array<double, 5> kGaussPoint{0.04691007703066802, 0.23076534494715845, 0.5, 0.7692346550528415,
                                            0.953089922969332};
constexpr std::array<double, 5> kGaussWeight{0.11846344252809454, 0.23931433524968324, 0.28444444444444444,
                                             0.23931433524968324, 0.11846344252809454};

/// Signed distance from a body, its gradient, and a length that tells how large the body is.
struct Distance {
  double value = 0;
  Vector3d gradient = Vector3d::Zero();
  double radius_m = 0;
};

/// Of a tube that begins at the node with a hemisphere (so that tubes in line have no seam) and ends flat;
/// negative inside.
Distance CalcTubeDistance(const JointArm& arm, double length_m, const Vector3d& p) {
  const double along = p.dot(arm.outward), from_node = p.norm();
  if (along <= 0 && from_node > 0) return {from_node - arm.radius_m, p / from_node, arm.radius_m};
  const Vector3d across = p - along * arm.outward;
  const double off_axis = across.norm(), beside = off_axis - arm.radius_m, beyond = along - length_m;
  const Vector3d out = off_axis > 0 ? Vector3d(across / off_axis) : arm.outward.unitOrthogonal();
  if (beside <= 0 || beyond <= 0) {
    return beside > beyond ? Distance{beside, out, arm.radius_m}
                           : Distance{beyond, arm.outward, arm.radius_m};
  }
  const double distance = std::hypot(beside, beyond);
  return {distance, (beside * out + beyond * arm.outward) / distance, arm.radius_m};
}

/// Distance from the union of two bodies whose crease is filled with a fillet: the polynomial smooth minimum
/// (Quilez). The fillet is as wide as the smaller body's radius times kFillet where they meet at a right
/// angle, and vanishes where they touch in one tangent plane.
double CalcFilletDistance(const Distance& a, const Distance& b) {
  const double width = kFillet * std::min(a.radius_m, b.radius_m) * (1 - a.gradient.dot(b.gradient));
  const double nearer = std::min(a.value, b.value), overlap = width - std::abs(a.value - b.value);
  return overlap > 0 ? nearer - overlap * overlap / (4 * width) : nearer;
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

/// A rectangle of a surface's parameters.
struct Patch {
  double u, v, du, dv;
};

class Builder {
 public:
  Builder(const Joint& joint, std::span<const double> core_m, double wall_spacing)
      : joint_(joint), core_m_(core_m), wall_spacing_(wall_spacing) {
    double area = 0;
    for (std::size_t i = 0; i < joint.arms.size(); ++i) area += 2 * pi * core_m[i] / joint.arms[i].radius_m;
    coarseness_ = std::sqrt(std::max(1.0, area / kOrdinaryArea));
  }

  JunctionWall Build() {
    for (std::size_t i = 0; i < joint_.arms.size(); ++i) AddTubeSources(i);
    for (std::size_t i = 0; i < joint_.arms.size(); ++i) AddOpeningSources(i);
    AddSphereSources();
    for (std::size_t i = 0; i < joint_.arms.size(); ++i) {
      AddTube(i);
      AddSections(i);
    }
    AddSphere();
    return std::move(result_);
  }

 private:
  double Offset(double radius_m) const { return kSourceOffset * coarseness_ * radius_m; }

  /// Distances from all tubes but one, and from the sphere if so wanted.
  std::vector<Distance> CalcDistances(const Vector3d& p, int without_arm, bool sphere) const {
    std::vector<Distance> distances;
    for (std::size_t i = 0; i < joint_.arms.size(); ++i) {
      if (static_cast<int>(i) == without_arm) continue;
      distances.push_back(CalcTubeDistance(joint_.arms[i], core_m_[i], p));
    }
    const double r = p.norm();
    if (sphere && r > 0) distances.push_back({r - joint_.sphere_radius_m, p / r, joint_.sphere_radius_m});
    return distances;
  }

  /// From the union with sharp lips.
  double SharpDistance(const Vector3d& p, int without_arm, bool sphere) const {
    double distance = std::numeric_limits<double>::infinity();
    for (const auto& of_one : CalcDistances(p, without_arm, sphere)) {
      distance = std::min(distance, of_one.value);
    }
    return distance;
  }

  /// From the water, lips rounded.
  double WaterDistance(const Vector3d& p) const {
    const std::vector<Distance> distances = CalcDistances(p, -1, true);
    double distance = distances.front().value;
    for (std::size_t i = 1; i < distances.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        distance = std::min(distance, CalcFilletDistance(distances[i], distances[j]));
      }
    }
    return distance;
  }

  Vector3d CalcGradient(const Vector3d& p) const {
    const double step = 1e-5 * joint_.sphere_radius_m;
    Vector3d gradient;
    for (int k = 0; k < 3; ++k) {
      const Vector3d d = step * Vector3d::Unit(k);
      gradient[k] = (WaterDistance(p + d) - WaterDistance(p - d)) / (2 * step);
    }
    return gradient;
  }

  /// The point near p at a distance from the water, by Newton along the gradient.
  Vector3d MoveTo(double distance_m, Vector3d p) const {
    for (int k = 0; k < 4; ++k) {
      const double off = distance_m - WaterDistance(p);
      if (std::abs(off) < 1e-9 * joint_.sphere_radius_m) break;
      const Vector3d gradient = CalcGradient(p);
      p += off / std::max(0.25, gradient.squaredNorm()) * gradient;
    }
    return p;
  }

  /// A source at least `offset` away; one that would be nearer moves out, unless it is inside or has company.
  void AddSource(const Vector3d& p, double offset) {
    const double distance = WaterDistance(p);
    if (distance < 0.1 * offset) return;
    const Vector3d place = distance < 0.9 * offset ? MoveTo(offset, p) : p;
    const auto close = [&](const Vector3d& other) { return (other - place).norm() < 0.4 * offset; };
    if (std::any_of(result_.sources.begin(), result_.sources.end(), close)) return;
    if (WaterDistance(place) > 0.8 * offset) result_.sources.push_back(place);
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

  /// A patch of a surface, given by a map from [u] x [v] to a wall point (its area per unit of u v): halved
  /// until it is smaller than its distance from the nearest source, so that no source hides between points.
  template <class Surface>
  void AddPatch(const Surface& surface, const Patch& patch, int depth) {
    const WallPoint point = surface(patch.u + 0.5 * patch.du, patch.v + 0.5 * patch.dv);
    const double area = point.area_m2 * patch.du * patch.dv;
    if (depth < kFinest && area > kPatchArea * NearestSource2_m2(point.p_N)) {
      const double du = 0.5 * patch.du, dv = 0.5 * patch.dv;
      for (const double u : {patch.u, patch.u + du}) {
        for (const double v : {patch.v, patch.v + dv}) AddPatch(surface, {u, v, du, dv}, depth + 1);
      }
    } else if (surface.belongs(point.p_N)) {
      const Vector3d p = MoveTo(0, point.p_N);
      result_.wall.push_back({p, CalcGradient(p).normalized(), area});
    }
  }

  double NearestSource2_m2(const Vector3d& p) const {
    double nearest = std::numeric_limits<double>::infinity();
    for (const Vector3d& source : result_.sources) nearest = std::min(nearest, (source - p).squaredNorm());
    return nearest;
  }

  /// A tube's wall over z and angle, where it is not inside the rest of the water.
  struct Tube {
    const Builder& builder;
    int arm;
    Matrix3d axes;
    double radius_m;
    WallPoint operator()(double z, double angle) const {
      const Vector3d out = std::cos(angle) * axes.col(0) + std::sin(angle) * axes.col(1);
      return {z * axes.col(2) + radius_m * out, out, radius_m};
    }
    bool belongs(const Vector3d& p) const { return builder.SharpDistance(p, arm, true) >= 0; }
  };

  void AddTube(std::size_t i) {
    const double radius = joint_.arms[i].radius_m, spacing = wall_spacing_ * coarseness_ * radius;
    const int rings = std::max(1, static_cast<int>(std::ceil(core_m_[i] / spacing)));
    const int count = CountAround(2 * pi * radius, spacing);
    const Tube tube{*this, static_cast<int>(i), MakeArmAxes(joint_, i), radius};
    const double dz = core_m_[i] / rings, turn = 2 * pi / count;
    for (int k = 0; k < rings * count; ++k) {
      AddPatch(tube, {dz * (k / count), turn * ((k % count) - 0.5), dz, turn}, 0);
    }
  }

  void AddSections(std::size_t i) {
    const double begin_m = std::max(joint_.arms[i].reach_m + joint_.arms[i].radius_m, 0.4 * core_m_[i]);
    if (begin_m >= core_m_[i]) {  // too short for more than its end
      result_.sections.push_back({i, 0, MakeSection(i, core_m_[i])});
      return;
    }
    for (int k = 0; k < kSections; ++k) {
      const double to_end_m = (core_m_[i] - begin_m) * (kSections - 1 - k) / (kSections - 1);
      result_.sections.push_back({i, to_end_m, MakeSection(i, core_m_[i] - to_end_m)});
    }
  }

  std::vector<WallPoint> MakeSection(std::size_t i, double z) const {
    const double radius = joint_.arms[i].radius_m;
    const Matrix3d axes = MakeArmAxes(joint_, i);
    std::vector<WallPoint> section;
    for (std::size_t k = 0; k < kGaussPoint.size(); ++k) {
      const double r = radius * kGaussPoint[k];
      const double area = 2 * pi * r * radius * kGaussWeight[k] / kSectionAngles;
      ForRing(axes, z, r, kSectionAngles, [&](const Vector3d& p, const Vector3d&) {
        section.push_back({p, axes.col(2), area});
      });
    }
    return section;
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

  /// Around the opening of a narrow tube in a wide one the sources of neither resolve the other's wall: rings
  /// beside the tube, as near to the wide wall as suits the narrow one.
  void AddOpeningSources(std::size_t i) {
    const JointArm& arm = joint_.arms[i];
    const double offset = Offset(arm.radius_m), spacing = kSourceSpacing * coarseness_ * arm.radius_m;
    for (const double part : {1.5, 2.0, 2.6}) {
      const double radius = part * arm.radius_m;
      if (radius > 0.9 * joint_.sphere_radius_m) break;
      ForRing(MakeArmAxes(joint_, i), 0, radius, CountAround(2 * pi * radius, 1.4 * spacing),
              [&](const Vector3d& p, const Vector3d&) {
                double inner = 0, outer = core_m_[i];
                for (int k = 0; k < 40; ++k) {
                  const double mid = 0.5 * (inner + outer);
                  (WaterDistance(p + mid * arm.outward) > offset ? outer : inner) = mid;
                }
                AddSource(p + outer * arm.outward, offset);
              });
    }
  }

  /// Axes of the sphere: z normal to the arms' plane, x where the arms' sections pull together.
  Matrix3d MakeSphereAxes() const {
    Vector3d sum = Vector3d::Zero(), across = Vector3d::Zero();
    for (const JointArm& arm : joint_.arms) {
      sum += arm.radius_m * arm.radius_m * arm.outward;
      if (across.norm() < 0.1) across = joint_.arms[0].outward.cross(arm.outward);
    }
    const double unit = joint_.sphere_radius_m * joint_.sphere_radius_m;
    const Vector3d side = sum.norm() > 1e-3 * unit ? sum : joint_.arms[0].outward;
    return MakeAxes(across.norm() < 0.1 ? Vector3d(side.unitOrthogonal()) : Vector3d(across.normalized()),
                    side);
  }

  void AddSphereSources() {
    const double offset = Offset(joint_.sphere_radius_m), radius = joint_.sphere_radius_m + offset;
    const double spacing = kSourceSpacing * coarseness_ * joint_.sphere_radius_m;
    const Matrix3d axes = MakeSphereAxes();
    const int rings = std::max(2, static_cast<int>(std::lround(pi * radius / spacing)));
    for (int k = 0; k < rings; ++k) {
      const double polar = pi * (k + 0.5) / rings, r = radius * std::sin(polar);
      ForRing(axes, radius * std::cos(polar), r, CountAround(2 * pi * r, spacing),
              [&](const Vector3d& p, const Vector3d&) { AddSource(p, offset); });
    }
  }

  /// The sphere over z and angle (Archimedes: equal areas), where it is not inside a tube.
  struct Sphere {
    const Builder& builder;
    Matrix3d axes;
    double radius_m;
    WallPoint operator()(double z, double angle) const {
      const double r = std::sqrt(std::max(0.0, radius_m * radius_m - z * z));
      const Vector3d out = std::cos(angle) * axes.col(0) + std::sin(angle) * axes.col(1);
      const Vector3d p = z * axes.col(2) + r * out;
      return {p, p / radius_m, radius_m};
    }
    bool belongs(const Vector3d& p) const { return builder.SharpDistance(p, -1, false) >= 0; }
  };

  void AddSphere() {
    const double radius = joint_.sphere_radius_m, spacing = wall_spacing_ * coarseness_ * radius;
    const int rings = std::max(2, static_cast<int>(std::lround(2 * radius / spacing)));
    const int count = CountAround(2 * pi * radius, spacing);
    const Sphere sphere{*this, MakeSphereAxes(), radius};
    const double dz = 2 * radius / rings, turn = 2 * pi / count;
    for (int k = 0; k < rings * count; ++k) {
      AddPatch(sphere, {dz * (k / count) - radius, turn * ((k % count) - 0.5), dz, turn}, 0);
    }
  }

  const Joint& joint_;
  std::span<const double> core_m_;
  double wall_spacing_;    ///< in radii
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

JunctionWall MakeJunctionWall(const Joint& joint, std::span<const double> core_m, double wall_spacing) {
  return Builder(joint, core_m, wall_spacing).Build();
}

}  // namespace piperun::sim
