#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/leak.h"
#include "base/route.h"
#include "base/water.h"
#include "scenarios/scenario.h"
#include "sim/flow_timeline.h"
#include "sim/network/model.h"

namespace piperun::scenarios {

/// The pipes of a scenario with water and leaks in them.
struct Pipeline {
  NetworkParams drawing;  ///< nodes and pipes as laid out, for whoever needs a map; their sound resolved
  Network network;
  sim::FlowTimeline flow;
  std::vector<Leak> leaks;             ///< those listed, then those drawn
  std::vector<LeakState> leak_states;  ///< at the launch
  int launch_node = 0;
  int retrieve_node = -1;                           ///< -1: wherever the water takes the ball
  std::vector<RouteLeg> plan;                       ///< the way the crew expects
  std::vector<std::string> notes;                   ///< what was assumed where the file is silent
  std::optional<sim::HydraulicModel> hydraulics{};  ///< of an EPANET file, with the leaks in it
  std::vector<std::string> warnings{};              ///< laws used beyond their range; leaks without sound
};

/// Thrown when the hydraulics of a network do not converge; a run then has the status hydraulics_diverged.
class HydraulicsDiverged : public std::exception {
 public:
  explicit HydraulicsDiverged(std::string what) : what_(std::move(what)) {}
  const char* what() const noexcept override { return what_.c_str(); }

 private:
  std::string what_;
};

/// Builds it. Throws InputError with key path, HydraulicsDiverged.
Pipeline BuildPipeline(const Scenario& scenario, const WaterProperties& water);

}  // namespace piperun::scenarios
