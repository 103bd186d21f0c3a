#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "base/params.h"
#include "base/random.h"
#include "sim/bore.h"

namespace piperun::sim {

/// The pipe that features are to stand in, and what decides whether they fit. References: the caller's.
struct WallFeatureSite {
  const Bore& bore;
  int pipe = 0;  ///< open to the ball
  double ball_radius_m = 0;
  Vector3d gravity_W{0, 0, -9.80665};
  RandomStream random;  ///< of these features in this pipe

  const Pipe& At() const { return bore.network().pipe(pipe); }
  /// Across the pipe at s, unit, `clock` radians from up (against gravity), clockwise seen along s; in a
  /// vertical pipe from east.
  Vector3d ClockDirection(double s_m, double clock_rad) const;
};

/// What a feature needs around it.
struct FeatureRoom {
  double before_m = 0;    ///< of undisturbed bore before its place
  double after_m = 0;     ///< and behind
  bool straight = false;  ///< all on one straight
  /// Its flattest curvature radius along the pipe: a bend within a diameter must be rounder on its inner
  /// side, or the feature would reach out of the wall far from where it stands.
  double flattest_m = 0;
};

/// Where features of one entry stand: one of them at `s_m`, or a series along the pipe,
///
///   s_1 = first,   s_{k+1} = s_k + spacing + spacing_sd N(0, 1),
///
/// up to the pipe's end: sticks of pipe, whose lengths scatter one by one.
struct FeaturePlaces {
  std::optional<double> s_m;
  std::optional<double> spacing_m;
  double spacing_sd_m = 0;
  std::optional<double> first_m;

  void Visit(ParamVisitor& v);
  /// The places, each with its number in the series (for RandomStream's sample). Places of a series without
  /// room are left out: beyond the pipe, in a reducer, within a diameter of what a joint of pipes reaches to,
  /// in a bend where the feature must lie straight or is flatter than the bend. Throws InputError (s_m,
  /// spacing_m, spacing_sd_m) when neither or both ways are given, the scatter could turn the order round
  /// (above a ninth of the spacing), or there is no room for the one at s_m.
  struct Place {
    double s_m = 0;
    std::uint64_t number = 0;
  };
  std::vector<Place> Find(const WallFeatureSite& site, const FeatureRoom& room) const;
};

/// A size that scatters: normal, drawn again beyond 3 sigma; below 0 it counts as 0. `slot` tells the sizes
/// of one feature apart.
struct ScatteredSize {
  double mean_m = 0;
  double sd_m = 0;

  double Largest_m() const { return mean_m + 3 * sd_m; }
  double Draw_m(const RandomStream& random, std::uint64_t sample, std::uint64_t slot) const;
};

/// Throws InputError for `key` unless value < limit; `what` names the limit. Sizes that scatter are held to
/// it with their largest value.
void RequireBelow(double value_m, double limit_m, std::string_view what, const char* key);

struct WallFeatureKind {
  std::string_view name;
  std::string_view doc;
  std::unique_ptr<Params> (*make_params)();
  /// Features in the order of their places. Throws InputError for what does not fit the pipe or the ball.
  /// That the ball cannot pass a protrusion or an opening is none.
  std::vector<WallFeature> (*make)(const Params& params, const WallFeatureSite& site);
};

/// Generated from sim/features/*.cc.
const std::vector<WallFeatureKind>& WallFeatureKinds();

}  // namespace piperun::sim
