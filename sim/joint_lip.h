#pragma once

#include <array>
#include <optional>
#include <span>

#include "sim/bore_member.h"

namespace piperun::sim {

/// The rim of a tube in a joint: where its generator lines leave the other members for good.
///
/// For tube i with begin o, axis a and radius R, in the members' frame N,
///
///   q(phi) = o + R e(phi) + t(phi) a,   e = cos(phi) u + sin(phi) w,   t(phi) = max over others of CalcExit,
///
/// closed form per member. Beyond t(phi) the tube's own wall begins; before it there is water. The rim is an
/// edge that points into the water: a ball rolls over it. A union of convex bodies has no other edges.
///
/// Exact to rounding, but for an edge that lies before a later opening on both of its walls: that takes three
/// tubes nested within some ten degrees.
class JointLip {
 public:
  static constexpr int kSamples = 64;

  /// Rim of members[tube] among `members`.
  JointLip(std::span<const BoreMember> members, std::size_t tube);

  bool exists() const { return exists_; }

  /// Adds the points of the rim that are locally nearest to p and at most `limit_m` away, if p lies in the
  /// normal cone of the edge there (between the normals of the two walls: their feet go over into this one
  /// without a jump); where three walls meet, always. On a rim that is about as far all around (within
  /// `ring_m`), three fixed points 120 degrees apart are added: a ball too large for it sits on more points
  /// than one.
  void AddFeet(std::span<const BoreMember> members, const Vector3d& p_N, double limit_m, double ring_m,
               WallFeet& feet) const;

 private:
  /// The rim at one angle. `tangent`: along the rim towards larger phi, any length.
  struct Point {
    Vector3d q;
    Vector3d tangent;
    Vector3d normal;        ///< of the tube's own wall
    Vector3d other_normal;  ///< of the wall of the member left last
  };
  struct Minimum {
    std::optional<Point> point;
    bool corner = false;
  };
  struct Bracket {
    double middle = 0, at_middle = 0;  ///< angle of the sample, slope there
    double beside = 0, at_beside = 0;
  };
  std::optional<Point> Eval(std::span<const BoreMember> members, double phi) const;
  std::optional<Bracket> FindBracket(std::span<const BoreMember> members, const Vector3d& p_N,
                                     int sample) const;
  Minimum FindMinimum(std::span<const BoreMember> members, const Vector3d& p_N, int sample) const;
  void AddFoot(const Vector3d& p_N, const Minimum& minimum, WallFeet& feet) const;
  void AddRing(const Vector3d& p_N, int nearest, WallFeet& feet) const;
  std::optional<double> CalcSlope(std::span<const BoreMember> members, const Vector3d& p_N, double phi) const;

  std::size_t tube_ = 0;
  Vector3d u_, w_;
  bool exists_ = false;
  Vector3d centre_;  // of a sphere around the rim
  double extent_m_ = 0;
  std::array<Vector3d, kSamples> samples_;  // far away where there is no rim
};

}  // namespace piperun::sim
