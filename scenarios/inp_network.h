#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scenarios/material_rules.h"
#include "scenarios/scenario.h"
#include "sim/network/model.h"

namespace piperun::scenarios {

/// How the drawing of an EPANET file becomes pipes in space.
struct DrawingParams {
  std::optional<double> map_unit_m;    ///< nothing: fitted to the stated lengths
  double bend_radius_diameters = 1.5;  ///< of the axis, over the bore
  MaterialRules materials;
};

struct InpDrawing {
  NetworkParams network;           ///< its fittings are the pumps and valves
  std::vector<std::string> notes;  ///< what was assumed, for the user to read
};

/// The pipes that an EPANET model describes. Node i and pipe i are the model's node i and link i: junctions,
/// reservoirs, tanks; pipes, pumps, valves.
///
/// - W is metres east and north of the lower left corner of the drawing, z the elevation. A unit of the map
/// is
///   map_unit_m; fitted, it is the median over the pipes of sqrt(L^2 - dz^2) over the drawn length in plan, L
///   the stated length.
/// - A reservoir's elevation in EPANET is its water level. Its pipe leaves it further down: z is that of the
///   lowest neighbour, or the water level where that is lower. Reservoirs and tanks are open water.
/// - Pipes have their stated length; vertices lie on a straight slope between the ends. Bends have
///   bend_radius_diameters, less where they do not fit.
/// - Pumps and valves have no length in EPANET: here max(2 D, 1.2 |dz|). D is the valve's bore, of a pump
/// that of
///   the narrowest pipe or valve beside it (of the network, if there is none beside it).
/// - A ball does not pass pumps, closed links, check valves, nor valves that control (sim::IsWideOpen).
/// - Material and wall come from the rules; roughness of the bore from the file when its law is
/// Darcy-Weisbach,
///   else from the material.
///
/// Throws InputError when nodes have no coordinates (how many, and which first), or when no scale can be
/// fitted.
InpDrawing DrawNetwork(const sim::HydraulicModel& model, const DrawingParams& params);

}  // namespace piperun::scenarios
