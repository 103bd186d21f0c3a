#include "sim/joint_lip.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace piperun::sim {
namespace {

constexpr double kNowhere_m = 1e6;
constexpr double kAtBegin = 1e-9;         // of the radius: a rim this near to the tube's begin is none
constexpr double kSmooth = 1e-9;          // 1 - cos of the angle between two walls that meet without an edge
constexpr double kConeSlack_m = 1e-10;    // walls' and edges' feet overlap by this much
constexpr double kPlateau_m = 1e-9;       // as far all around: no point is nearest
constexpr double kPerpendicular = 1e-7;   // cosine, at a minimum on a smooth stretch of the rim
constexpr double kContinuous_m = 1e-7;    // the rim's two sides of a corner
constexpr double kAngleStep_rad = 1e-13;  // of the last correction
constexpr int kMaxCorrections = 100;

double SampleAngle(int k) { return 2 * std::numbers::pi / JointLip::kSamples * k; }

struct Sample {
  double x = 0;
  double f = 0;
};

/// Where a function changes sign from - to +: a zero, or a jump across it.
struct SignChange {
  double below = 0;
  double above = 0;
};

SignChange MakeSignChange(const Sample& a, const Sample& b) {
  return a.f < 0 ? SignChange{a.x, b.x} : SignChange{b.x, a.x};
}

/// Where between a and b the inverse parabola through three samples has its zero, as a share; half way where
/// the parabola is not to be trusted.
double CalcShare(const Sample& a, const Sample& b, const Sample& c) {
  const double xi = (a.x - b.x) / (c.x - b.x), phi = (a.f - b.f) / (c.f - b.f);
  if (phi * phi >= xi || (1 - phi) * (1 - phi) >= 1 - xi) return 0.5;
  return a.f / (b.f - a.f) * c.f / (b.f - c.f) +
         (c.x - a.x) / (b.x - a.x) * a.f / (c.f - a.f) * b.f / (c.f - b.f);
}

/// Chandrupatla, "A new hybrid quadratic/bisection algorithm for finding the zero of a nonlinear function
/// without using derivatives", Adv. Eng. Softw. 28, 145 (1997). Between samples of unlike sign.
template <class F>
SignChange FindSignChange(const F& f, Sample a, Sample b) {
  double share = 0.5;
  for (int i = 0; i < kMaxCorrections; ++i) {
    const double x = a.x + share * (b.x - a.x);
    const Sample next{x, f(x)};
    if (next.f == 0) return {x, x};
    const bool beside_a = (next.f < 0) == (a.f < 0);
    const Sample c = beside_a ? a : b;
    if (!beside_a) b = a;
    a = next;
    const double least = kAngleStep_rad / std::abs(b.x - a.x);
    if (least > 0.5) break;
    share = std::clamp(CalcShare(a, b, c), least, 1 - least);
  }
  return MakeSignChange(a, b);
}

}  // namespace

JointLip::JointLip(std::span<const BoreMember> members, std::size_t tube)
    : tube_(tube), u_(members[tube].axis.unitOrthogonal()), w_(members[tube].axis.cross(u_)) {
  Vector3d min = Vector3d::Constant(kNowhere_m), max = -min;
  for (int k = 0; k < kSamples; ++k) {
    const auto point = Eval(members, SampleAngle(k));
    samples_[static_cast<std::size_t>(k)] = point ? point->q : Vector3d::Constant(kNowhere_m);
    if (!point) continue;
    exists_ = true;
    min = min.cwiseMin(point->q);
    max = max.cwiseMax(point->q);
  }
  centre_ = 0.5 * (min + max);
  // a rim may reach past its samples, by no more than it turns between two of them
  extent_m_ = 0.5 * (max - min).norm() + 2 * std::numbers::pi / kSamples * members[tube].radius_m;
}

std::optional<JointLip::Point> JointLip::Eval(std::span<const BoreMember> members, double phi) const {
  const BoreMember& tube = members[tube_];
  const Vector3d e = std::cos(phi) * u_ + std::sin(phi) * w_;
  const Vector3d begin = tube.origin + tube.radius_m * e;
  const BoreMember* left = nullptr;
  double t = kAtBegin * tube.radius_m;
  for (const BoreMember& member : members) {
    if (&member == &tube) continue;
    const double exit = CalcExit(member, begin, tube.axis);
    if (exit <= t) continue;
    t = exit;
    left = &member;
  }
  if (!left || t >= tube.length_m) return std::nullopt;
  Point point;
  point.q = begin + t * tube.axis;
  point.normal = -e;
  point.other_normal = CalcWallNormal(*left, point.q);
  // dq = R e' dphi + a dt stays on the other wall; leaving it, a . other_normal <= 0
  const Vector3d around = tube.radius_m * (std::cos(phi) * w_ - std::sin(phi) * u_);
  point.tangent = point.other_normal.dot(around) * tube.axis - point.other_normal.dot(tube.axis) * around;
  return point;
}

/// Derivative of half the squared distance along the rim, up to a positive factor.
std::optional<double> JointLip::CalcSlope(std::span<const BoreMember> members, const Vector3d& p_N,
                                          double phi) const {
  const auto point = Eval(members, phi);
  if (!point) return std::nullopt;
  return (point->q - p_N).dot(point->tangent);
}

/// The stretch of the rim beside a sample, nearer than its neighbours, in which the least distance lies:
/// the slope rises through zero. Two minima within a few degrees may count as one; one as near to an end of
/// the rim is found on the rim of the tube that goes on from there.
std::optional<JointLip::Bracket> JointLip::FindBracket(std::span<const BoreMember> members,
                                                       const Vector3d& p_N, int sample) const {
  const double middle = SampleAngle(sample);
  const auto at_middle = CalcSlope(members, p_N, middle);
  if (!at_middle) return std::nullopt;
  const bool upper = *at_middle < 0;
  for (const double share : {1.0, 0.25, 0.5, 0.75}) {  // the first does, but where extrema or ends crowd
    const double phi = middle + (upper ? share : -share) * SampleAngle(1);
    const auto slope = CalcSlope(members, p_N, phi);
    if (slope && (upper ? *slope > 0 : *slope < 0)) return Bracket{middle, *at_middle, phi, *slope};
  }
  return std::nullopt;
}

JointLip::Minimum JointLip::FindMinimum(std::span<const BoreMember> members, const Vector3d& p_N,
                                        int sample) const {
  const auto bracket = FindBracket(members, p_N, sample);
  if (!bracket) return {};
  const SignChange at =
      FindSignChange([&](double phi) { return CalcSlope(members, p_N, phi).value_or(0); },
                     {bracket->middle, bracket->at_middle}, {bracket->beside, bracket->at_beside});
  const auto point = Eval(members, at.below), above = Eval(members, at.above);
  if (!point || !above) return {};
  const Vector3d from_p = point->q - p_N;
  if (std::abs(from_p.dot(point->tangent)) <= kPerpendicular * from_p.norm() * point->tangent.norm()) {
    return {point, false};
  }
  // a step of the rim is no corner: another tube's rim goes on from there
  if ((above->q - point->q).norm() > kContinuous_m) return {};
  return {point, true};
}

void JointLip::AddFoot(const Vector3d& p_N, const Minimum& minimum, WallFeet& feet) const {
  if (!minimum.point) return;
  const Point& at = *minimum.point;
  const Vector3d d = p_N - at.q;
  const double cosine = at.normal.dot(at.other_normal);
  if (!minimum.corner) {
    if (cosine > 1 - kSmooth) return;
    if (d.dot(at.normal - cosine * at.other_normal) < -kConeSlack_m) return;
    if (d.dot(at.other_normal - cosine * at.normal) < -kConeSlack_m) return;
  }
  const double distance_m = d.norm();
  if (distance_m > 0) feet.Add({d / distance_m, distance_m, WallFoot::Kind::kSheet});
}

void JointLip::AddRing(const Vector3d& p_N, int nearest, WallFeet& feet) const {
  for (const int third : {0, 1, 2}) {
    const int k = (nearest + third * kSamples / 3) % kSamples;
    const Vector3d d = p_N - samples_[static_cast<std::size_t>(k)];
    const double distance_m = d.norm();
    if (distance_m > 0) feet.Add({d / distance_m, distance_m, WallFoot::Kind::kPoint});
  }
}

void JointLip::AddFeet(std::span<const BoreMember> members, const Vector3d& p_N, double limit_m,
                       double ring_m, WallFeet& feet) const {
  if ((p_N - centre_).norm() > limit_m + extent_m_) return;
  std::array<double, kSamples> distance_m;
  for (std::size_t k = 0; k < kSamples; ++k) distance_m[k] = (samples_[k] - p_N).norm();
  const auto [min, max] = std::minmax_element(distance_m.begin(), distance_m.end());
  if (*min > limit_m + SampleAngle(1) * members[tube_].radius_m) return;
  if (*max - *min < ring_m) AddRing(p_N, static_cast<int>(min - distance_m.begin()), feet);
  if (*max - *min < kPlateau_m) return;
  for (int k = 0; k < kSamples; ++k) {
    const double here = distance_m[static_cast<std::size_t>(k)];
    const double before = distance_m[static_cast<std::size_t>((k + kSamples - 1) % kSamples)];
    const double after = distance_m[static_cast<std::size_t>((k + 1) % kSamples)];
    if (here < before && here <= after && here < limit_m + SampleAngle(1) * members[tube_].radius_m) {
      AddFoot(p_N, FindMinimum(members, p_N, k), feet);
    }
  }
}

}  // namespace piperun::sim
