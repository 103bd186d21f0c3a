#pragma once

#include <string_view>
#include <utility>
#include <vector>

#include "sim/wall_feature.h"
#include "tests/support/pipes.h"
#include "tests/support/set_params.h"

namespace piperun::testing {

/// Features of a kind in pipe 0 of a bore, with parameters by their names.
inline std::vector<sim::WallFeature> MakeFeatures(const sim::Bore& bore, std::string_view kind,
                                                  const ParamValues& values, double ball_radius_m = 0.03,
                                                  std::uint64_t seed = 1) {
  const auto& of_kind = FindKind(sim::WallFeatureKinds(), kind);
  const auto params = MakeParamsOf(of_kind, values);
  return of_kind.make(*params,
                      {bore, 0, ball_radius_m, {0, 0, -9.80665}, RandomStream(seed, "wall_features.F.P", 0)});
}

/// Puts features of a kind onto pipe 0, beside those that are there.
inline void AddFeatures(sim::Bore& bore, std::string_view kind, const ParamValues& values,
                        double ball_radius_m = 0.03, std::uint64_t seed = 1) {
  std::vector<sim::WallFeature> all = bore.features();
  for (sim::WallFeature& feature : MakeFeatures(bore, kind, values, ball_radius_m, seed)) {
    all.push_back(std::move(feature));
  }
  bore.SetFeatures(std::move(all));
}

}  // namespace piperun::testing
