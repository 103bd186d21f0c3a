#include "sim/wall_feature.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "base/check.h"
#include "base/number.h"

namespace piperun::sim {
namespace {

constexpr double kVertical = 1e-9;         // sine of the angle to gravity
constexpr double kScatterLimit = 9;        // a normal number of ours stays below 8.58
constexpr double kSigmas = 3;              // of a scattered size
constexpr std::uint64_t kMaxRedraws = 64;  // 4 numbers each, of which 0.3 % are refused
constexpr std::uint64_t kSpacingSlot = 0, kSizeSlots = 1000;

/// How much of a pipe's end is taken by a joint: its reach, and a diameter.
double CalcTaken_m(const WallFeatureSite& site, bool at_to) {
  const Pipe& pipe = site.At();
  const Joint& joint = site.bore.joint(at_to ? pipe.to : pipe.from);
  const double cone_m = at_to ? pipe.cone_to.length_m : pipe.cone_from.length_m;
  if (joint.smooth) return cone_m;
  return std::max(cone_m, site.bore.FindArm(joint, {site.pipe, at_to}).reach_m + pipe.diameter_m);
}

bool IsOnStraight(const Pipe& pipe, double a_m, double b_m) {
  return std::any_of(pipe.centreline.begin(), pipe.centreline.end(), [&](const CentrelinePiece& piece) {
    return piece.straight() && a_m >= piece.s_begin_m && b_m <= piece.s_end_m();
  });
}

/// Radius, along the pipe, of the wall on the inner side of the tightest bend between a and b; a bend behind
/// a smooth joint counts.
double FindTightestInside_m(const WallFeatureSite& site, double a_m, double b_m) {
  double tightest_m = std::numeric_limits<double>::infinity();
  const auto count = [&](const CentrelinePiece& piece) {
    if (!piece.straight()) {
      tightest_m = std::min(tightest_m, 1 / piece.curvature_1_m - site.At().radius_m());
    }
  };
  for (const CentrelinePiece& piece : site.At().centreline) {
    if (piece.s_begin_m < b_m && piece.s_end_m() > a_m) count(piece);
  }
  for (const bool at_to : {false, true}) {
    const Joint& joint = site.bore.joint(at_to ? site.At().to : site.At().from);
    if (!joint.smooth || (at_to ? b_m < site.At().length_m : a_m > 0)) continue;
    const PipeEnd here{site.pipe, at_to};
    const PipeEnd there = joint.arms[joint.arms[0].end == here ? 1 : 0].end;
    const auto& next = site.bore.network().pipe(there.pipe).centreline;
    count(there.at_to ? next.back() : next.front());
  }
  return tightest_m;
}

bool HasRoom(const WallFeatureSite& site, double s_m, const FeatureRoom& room) {
  const double a_m = s_m - room.before_m, b_m = s_m + room.after_m;
  if (a_m < CalcTaken_m(site, false) || b_m > site.At().length_m - CalcTaken_m(site, true)) return false;
  if (room.straight && !IsOnStraight(site.At(), a_m, b_m)) return false;
  const double felt_m = site.At().diameter_m;
  return FindTightestInside_m(site, a_m - felt_m, b_m + felt_m) > room.flattest_m;
}

void RequireRoom(const WallFeatureSite& site, double s_m, const FeatureRoom& room) {
  if (HasRoom(site, s_m, room)) return;
  const double least_m = CalcTaken_m(site, false) + room.before_m;
  const double most_m = site.At().length_m - CalcTaken_m(site, true) - room.after_m;
  std::string problem =
      FormatNumber(s_m) + " leaves no room for it in pipe '" + site.At().id + "'; it needs " +
      FormatNumber(room.before_m) + " m before and " + FormatNumber(room.after_m) +
      " m behind, clear of reducers and of a diameter around joints of pipes: allowed " +
      (least_m <= most_m ? "[" + FormatNumber(least_m) + ", " + FormatNumber(most_m) + "]" : "nowhere");
  if (room.straight) problem += ", on one straight";
  if (room.flattest_m > 0) {
    problem += ", and no bend within a diameter whose inner side is tighter than its own curve, " +
               FormatNumber(room.flattest_m) + " m";
  }
  throw InputError(problem, "s_m");
}

}  // namespace

Vector3d WallFeatureSite::ClockDirection(double s_m, double clock_rad) const {
  const Vector3d x_W = At().Eval(s_m).tangent_W;
  Vector3d up_W = gravity_W.dot(x_W) * x_W - gravity_W;
  if (up_W.norm() <= kVertical * gravity_W.norm()) up_W = Vector3d::UnitX() - x_W.x() * x_W;
  up_W.normalize();
  return std::cos(clock_rad) * up_W + std::sin(clock_rad) * x_W.cross(up_W);
}

void FeaturePlaces::Visit(ParamVisitor& v) {
  v.NumberOr({"s_m", "Where the only one stands, along its pipe from the `from` node."}, Range::NonNegative(),
             "series", s_m);
  v.NumberOr({"spacing_m", "A series: distance from one to the next."}, {.min = 0.01, .max = 1e5}, "none",
             spacing_m);
  v.Number({"spacing_sd_m", "Scatter of each of these distances, at most a ninth of it."},
           Range::NonNegative(), spacing_sd_m);
  v.NumberOr({"first_m", "A series: where the first one stands; one distance into the pipe unless given."},
             Range::NonNegative(), "spacing", first_m);
}

std::vector<FeaturePlaces::Place> FeaturePlaces::Find(const WallFeatureSite& site,
                                                      const FeatureRoom& room) const {
  if (s_m && spacing_m) throw InputError("one place or a series: give s_m or spacing_m, not both", "s_m");
  if (s_m) {
    RequireRoom(site, *s_m, room);
    return {{*s_m, 0}};
  }
  if (!spacing_m) throw InputError("the place is missing; give s_m, or spacing_m for a series", "s_m");
  if (spacing_sd_m * kScatterLimit > *spacing_m) {
    throw InputError(FormatNumber(spacing_sd_m) + " is too much scatter; allowed: [0, " +
                         FormatNumber(*spacing_m / kScatterLimit) + "], a ninth of the spacing",
                     "spacing_sd_m");
  }
  std::vector<Place> places;
  double at_m = first_m.value_or(*spacing_m);
  for (std::uint64_t number = 0; at_m <= site.At().length_m; ++number) {
    if (HasRoom(site, at_m, room)) places.push_back({at_m, number});
    at_m += *spacing_m + spacing_sd_m * site.random.Normals(number, kSpacingSlot)[0];
  }
  return places;
}

double ScatteredSize::Draw_m(const RandomStream& random, std::uint64_t sample, std::uint64_t slot) const {
  if (sd_m == 0) return mean_m;
  for (std::uint64_t redraw = 0; redraw < kMaxRedraws; ++redraw) {
    for (const double draw : random.Normals(sample, kSizeSlots * (slot + 1) + redraw)) {
      if (std::abs(draw) <= kSigmas) return std::max(0.0, mean_m + sd_m * draw);
    }
  }
  AbortWith("256 normal numbers in a row lie beyond 3 sigma", __FILE__, __LINE__);
}

void RequireBelow(double value_m, double limit_m, std::string_view what, const char* key) {
  if (value_m < limit_m) return;
  throw InputError(FormatNumber(value_m) + " m is too much; allowed: below " + FormatNumber(limit_m) +
                       " m, " + std::string(what),
                   key);
}

}  // namespace piperun::sim
