#include "scenarios/leak_list.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "base/number.h"
#include "base/random.h"
#include "scenarios/network_params.h"

namespace piperun::scenarios {
namespace {

constexpr int kMaxDraws = 10000;  // per leak, before we say that there is no room

Leak MakeLeak(const LeakEntry& entry, const Network& network, const std::string& key) {
  const int pipe = network.RequirePipe(entry.pipe, key + ".pipe");
  const Pipe& on = network.pipe(pipe);
  if (entry.s_m > on.length_m) {
    throw InputError(FormatNumber(entry.s_m) + " is beyond the end of pipe '" + on.id + "'; allowed: [0, " +
                         FormatNumber(on.length_m) + "]",
                     key + ".s_m");
  }
  if (entry.hole_diameter_m >= on.diameter_m) {
    throw InputError("the hole is wider than the pipe; allowed: below " + FormatNumber(on.diameter_m) + " m",
                     key + ".hole_diameter_m");
  }
  return {entry.id, pipe, entry.s_m, entry.hole_diameter_m, entry.cd, entry.area_slope_m};
}

/// Stretches of pipe to draw from, end to end.
struct Stretches {
  std::vector<int> pipes;
  std::vector<double> end_m;  // of each, counted from the first one's begin
};

Stretches FindStretches(const RandomLeaksParams& params, const Network& network,
                        const std::vector<RouteLeg>& plan) {
  Stretches stretches;
  const auto add = [&](int pipe) {
    const double begin_m = stretches.end_m.empty() ? 0 : stretches.end_m.back();
    stretches.pipes.push_back(pipe);
    stretches.end_m.push_back(begin_m + network.pipe(pipe).length_m);
  };
  if (params.where == "way") {
    for (const RouteLeg& leg : plan) add(leg.pipe);
  } else {
    for (std::size_t i = 0; i < network.pipes().size(); ++i) {
      if (network.pipes()[i].passable) add(static_cast<int>(i));
    }
  }
  return stretches;
}

bool HasRoom(const Leak& leak, const Network& network, const std::vector<Leak>& others, double spacing_m) {
  if (leak.s_m < spacing_m || leak.s_m > network.pipe(leak.pipe).length_m - spacing_m) return false;
  return std::none_of(others.begin(), others.end(), [&](const Leak& other) {
    return other.pipe == leak.pipe && std::abs(other.s_m - leak.s_m) < spacing_m;
  });
}

Leak DrawLeak(const RandomLeaksParams& params, const Stretches& stretches,
              const std::array<double, 4>& draw) {
  const double at_m = draw[0] * stretches.end_m.back();
  const auto end = std::upper_bound(stretches.end_m.begin(), stretches.end_m.end() - 1, at_m);
  const auto i = static_cast<std::size_t>(end - stretches.end_m.begin());
  const double ratio = params.max_hole_diameter_m / params.min_hole_diameter_m;
  return {"",
          stretches.pipes[i],
          at_m - (i == 0 ? 0 : stretches.end_m[i - 1]),
          params.min_hole_diameter_m * std::exp(draw[1] * std::log(ratio)),
          params.cd,
          0};
}

}  // namespace

std::vector<Leak> MakeListedLeaks(const Scenario& scenario, const Network& network) {
  std::vector<Leak> leaks;
  for (std::size_t i = 0; i < scenario.leaks.size(); ++i) {
    const LeakEntry& entry = scenario.leaks[i];
    const std::string key = "leaks[" + std::to_string(i) + "]";
    RequirePlainId(entry.id, key + ".id");
    if (std::any_of(leaks.begin(), leaks.end(), [&](const Leak& leak) { return leak.id == entry.id; })) {
      throw InputError("'" + entry.id + "' is used twice; ids must be unique", key + ".id");
    }
    leaks.push_back(MakeLeak(entry, network, key));
  }
  return leaks;
}

std::vector<Leak> DrawLeaks(const Scenario& scenario, const Network& network,
                            const std::vector<RouteLeg>& plan, const std::vector<Leak>& listed) {
  const RandomLeaksParams& params = scenario.random_leaks;
  if (params.min_hole_diameter_m > params.max_hole_diameter_m) {
    throw InputError("the smallest hole is larger than the largest", "random_leaks.min_hole_diameter_m");
  }
  const Stretches stretches = FindStretches(params, network, plan);
  const RandomStream random(static_cast<std::uint64_t>(scenario.seed), "random_leaks",
                            static_cast<std::uint64_t>(scenario.run));
  std::vector<Leak> leaks = listed;
  for (std::int64_t i = 0; i < params.count; ++i) {
    Leak leak;
    int draws = 0;
    do {
      if (draws == kMaxDraws) {
        throw InputError("there is no room for leak " + std::to_string(i + 1) + " of " +
                             std::to_string(params.count) + "; take fewer or a smaller min_spacing_m",
                         "random_leaks.count");
      }
      leak = DrawLeak(params, stretches,
                      random.Uniforms(static_cast<std::uint64_t>(i), static_cast<std::uint64_t>(draws++)));
    } while (!HasRoom(leak, network, leaks, params.min_spacing_m));
    leak.id = "R" + std::to_string(i + 1);
    if (std::any_of(listed.begin(), listed.end(), [&](const Leak& other) { return other.id == leak.id; })) {
      throw InputError("'" + leak.id + "' is the name of a drawn leak; choose another id",
                       "leaks." + leak.id);
    }
    leaks.push_back(std::move(leak));
  }
  return {leaks.begin() + static_cast<std::ptrdiff_t>(listed.size()), leaks.end()};
}

}  // namespace piperun::scenarios
