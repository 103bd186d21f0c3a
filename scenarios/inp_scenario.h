#pragma once

#include <string>

#include "scenarios/inp_network.h"

namespace piperun::scenarios {

/// What a scenario on an EPANET file is made of, before the user changes it.
struct InpScenarioPlan {
  std::string inp_path;  ///< as it is to stand in the scenario
  std::string name;
  std::string launch;
  std::string retrieve;
  double ball_diameter_m = 0;
  double time_limit_s = 3600;
  std::string leak_pipe;  ///< empty: no leak
  double leak_s_m = 0;
};

/// A scenario file: the network, the mission, a ball, the sensors and the filter of the quickstart, with
/// comments for whoever edits it.
std::string MakeInpScenario(const InpScenarioPlan& plan);

/// The plan of a run from one node to another by the way with the fewest pipes: a ball of 60 mm, or 0.4 of
/// the narrowest bore on the way where that is less, in whole millimetres; time for 5 cm/s; a leak in the
/// middle of the longest pipe. Throws InputError when a node is not in the file (with the nearest id that
/// is), or no way leads from one to the other.
InpScenarioPlan PlanInpScenario(const std::string& inp_path, const std::string& launch,
                                const std::string& retrieve);

}  // namespace piperun::scenarios
