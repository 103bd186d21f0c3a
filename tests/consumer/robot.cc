// What a robot links: a map, a filter from the table, and nothing of the simulator.
#include <algorithm>
#include <cstdio>

#include "base/network.h"
#include "estimator/filter_kind.h"

int main() {
  piperun::PipeSpec pipe;
  pipe.id = "P1";
  pipe.from = "A";
  pipe.to = "B";
  pipe.diameter_m = 0.15;
  pipe.wall_thickness_m = 0.0075;
  const piperun::Network network({{"A", {0, 0, 0}}, {"B", {30, 0, 0}}}, {pipe});
  piperun::estimator::EstimatorStart start;
  start.map.emplace(network, piperun::FindRoute(network, 0, 1));
  const auto& kinds = piperun::estimator::FilterKinds();
  const auto kind =
      std::find_if(kinds.begin(), kinds.end(), [](const auto& k) { return k.name == "quaternion_ekf"; });
  if (kind == kinds.end()) return 1;
  const auto filter = kind->make(*kind->make_params(), start);
  std::printf("%s on a map of %g m\n", std::string(kind->name).c_str(), start.map->route.length_m());
  return filter->leaks().empty() && !filter->nav().valid ? 0 : 1;
}
