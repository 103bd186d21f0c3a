#pragma once

#include <span>
#include <string>
#include <vector>

#include "sim/network/model.h"

namespace piperun::sim {

/// A hole at a place along a pipe.
struct PipeLeak {
  std::string id;
  int pipe = 0;    ///< index in HydraulicModel::pipes
  double s_m = 0;  ///< from the pipe's `from` node
  double area_m2 = 0;
  double head_area_slope_m = 0;  ///< dA/dh [m2/m]: how the hole opens with pressure (FAVAD); 0: rigid
  double discharge_coefficient = 0.6;
};

/// Q = Cd sqrt(2 g) (A0 h^0.5 + m h^1.5) as coefficients.
LeakCoefficients CalcLeakCoefficients(const PipeLeak& leak, double gravity_m_s2 = 9.80665);

/// Where a leak has come to lie.
struct LeakPlace {
  int junction = -1;  ///< in the new model
};

/// One piece of a pipe that leaks have cut.
struct PipePiece {
  int link = -1;  ///< in the new model
  double s_begin_m = 0;
  double s_end_m = 0;
};

struct LeakyModel {
  HydraulicModel model;
  std::vector<LeakPlace> leaks;               ///< in the order given
  std::vector<std::vector<PipePiece>> pipes;  ///< per pipe of the old model, along it
};

/// Cuts pipes at their leaks and puts a junction with the leak there; its elevation lies between those of the
/// pipe's ends in proportion. The pieces share length, minor loss and leakage of the pipe in proportion; a
/// check valve and whatever opens or closes the pipe stay with its first piece, which keeps the pipe's id.
/// New ids are made of the pipe's and the leak's ("P7:L1"). Throws InputError ("leaks[i]...") for a pipe that
/// does not exist, a place not strictly inside the pipe, two leaks at one place, sizes <= 0.
LeakyModel InsertLeaks(const HydraulicModel& model, std::span<const PipeLeak> leaks,
                       double gravity_m_s2 = 9.80665);

}  // namespace piperun::sim
