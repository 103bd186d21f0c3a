#include "base/polyline.h"

#include <cmath>
#include <utility>

#include "base/check.h"
#include "base/number.h"

namespace piperun {
namespace {

constexpr double kMinRun_m = 1e-6;     // in plan; below this a polyline is a point there
constexpr double kSameLength = 1e-12;  // relative; a rise this close to the length is vertical
constexpr int kMaxNewtonSteps = 200;

/// A straight's components: in plan (east, north) and upwards.
struct Leg {
  Eigen::Vector2d run;
  double rise = 0;
};

std::vector<Leg> MakeLegs(const std::vector<Vector3d>& vertices_W) {
  std::vector<Leg> legs;
  for (std::size_t i = 0; i + 1 < vertices_W.size(); ++i) {
    const Vector3d d = vertices_W[i + 1] - vertices_W[i];
    legs.push_back({d.head<2>(), d.z()});
  }
  return legs;
}

double CalcRun(const std::vector<Leg>& legs) {
  double sum = 0;
  for (const Leg& leg : legs) sum += leg.run.norm();
  return sum;
}

double CalcRise(const std::vector<Leg>& legs) {
  double sum = 0;
  for (const Leg& leg : legs) sum += std::abs(leg.rise);
  return sum;
}

/// Gives legs that are points in plan a run to the east, in proportion to their rise (or all the same).
void RunEast(std::vector<Leg>& legs) {
  const double rise = CalcRise(legs);
  for (Leg& leg : legs) leg.run = {rise > 0 ? std::abs(leg.rise) / rise : 1, 0};
}

/// Newton's method from the right on a convex rising function: every step stays on the right of the root, so
/// the first step that does not go left ends it.
double FindStretch(const std::vector<Leg>& legs, double length_m) {
  double f = length_m / CalcRun(legs);
  for (int step = 0; step < kMaxNewtonSteps; ++step) {
    double excess = -length_m, slope = 0;
    for (const Leg& leg : legs) {
      const double run = leg.run.norm();
      const double leg_length = std::hypot(f * run, leg.rise);
      excess += leg_length;
      if (leg_length > 0) slope += f * run * run / leg_length;
    }
    const double next = f - excess / slope;
    if (!(next < f)) break;
    f = next;
  }
  return f;
}

}  // namespace

std::string CornerName(std::size_t i, const Vector3d& p_W) {
  return "corner " + std::to_string(i) + " at [" + FormatNumber(p_W.x()) + ", " + FormatNumber(p_W.y()) +
         ", " + FormatNumber(p_W.z()) + "]";
}

Polyline MakePolyline(std::vector<Vector3d> vertices_W) {
  Demand(vertices_W.size() >= 2, "a polyline has at least two vertices");
  Polyline line;
  line.vertices_W = std::move(vertices_W);
  for (std::size_t i = 0; i + 1 < line.vertices_W.size(); ++i) {
    const Vector3d d = line.vertices_W[i + 1] - line.vertices_W[i];
    const double length_m = d.norm();
    if (!(length_m > kMinStraight_m)) {
      throw InputError("two neighbouring vertices coincide (" + CornerName(i + 1, line.vertices_W[i + 1]) +
                       "); a straight needs a length above " + FormatNumber(kMinStraight_m) + " m");
    }
    line.straights.push_back({d / length_m, length_m});
  }
  return line;
}

double CalcTurn_rad(const Vector3d& tangent_in, const Vector3d& tangent_out) {
  return std::atan2(tangent_in.cross(tangent_out).norm(), tangent_in.dot(tangent_out));
}

std::vector<Vector3d> StretchToLength(std::vector<Vector3d> vertices_W, double length_m) {
  std::vector<Leg> legs = MakeLegs(vertices_W);
  const double rise_m = CalcRise(legs);
  if (length_m < (1 - kSameLength) * rise_m) {
    throw InputError("the stated length " + FormatNumber(length_m) + " m is shorter than the rise of " +
                     FormatNumber(rise_m) + " m between its ends; correct the length or the elevations");
  }
  if (CalcRun(legs) < kMinRun_m) RunEast(legs);
  const bool vertical = length_m <= (1 + kSameLength) * rise_m;
  const double f = vertical ? 0 : FindStretch(legs, length_m);
  for (std::size_t i = 0; i < legs.size(); ++i) {
    vertices_W[i + 1].head<2>() = vertices_W[i].head<2>() + f * legs[i].run;
  }
  return vertices_W;
}

}  // namespace piperun
