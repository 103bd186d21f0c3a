#pragma once

#include <vector>

#include "base/network.h"

namespace piperun {

/// Node indices of a pipe's ends.
struct PipeNodes {
  int from = 0;
  int to = 0;
};

/// A network as described: what is where, and what meets what. The specs are valid one by one.
struct NetworkPlan {
  const std::vector<NodeSpec>& nodes;
  const std::vector<PipeSpec>& specs;
  const std::vector<PipeNodes>& pipe_nodes;       ///< per pipe
  const std::vector<std::vector<PipeEnd>>& ends;  ///< per node
};

/// Where one pipe of a network runs.
struct PipeCourse {
  std::vector<CentrelinePiece> centreline;
  Cone cone_from, cone_to;
};

/// Lays the pipes of a network, in this order:
///
/// 1. A stated length is law: the drawn line is stretched to it (StretchToLength).
/// 2. Corners are rounded. The corner between two pipes that meet alone at a node is rounded when both give a
///    bend radius, with the greater of the two: each pipe has one half of the bend, ending tangent to the
///    bisector; where the bores differ, all of it is in the wider pipe, so that the narrower one begins
///    straight. Where more pipes meet, or none or one radius is given, pipes end straight, corners stay
///    sharp.
/// 3. A pipe with `fit_bends` has its bends made tighter where they do not fit, down to 0.6 diameters. Where
///    even this is too wide, an inner vertex is left out of the line (and step 1 done again), and a corner
///    between pipes stays sharp, a mitre. Beside a sharp corner and a junction 1.5 diameters stay straight.
/// 4. The straights of a pipe of stated length are made longer or shorter by one factor, so that the
///    centreline has this length (FitStraights). That moves its far end by a fraction of the bends' radii;
///    of that the elevation gets the slope's share: millimetres, centimetres on a steep pipe with wide bends.
/// 5. Where two pipes of different bore meet without an angle, the narrower one gets a reducer (CalcCone).
///
/// So a pipe ends where its own lengths and directions lead, and drawings need not close. Throws InputError
/// with a key path under "network.pipes" for a length below the rise, for two vertices that coincide, and for
/// bends that do not fit on a pipe without fit_bends.
std::vector<PipeCourse> LayPipes(const NetworkPlan& plan);

/// The reducer at the end of a pipe of bore `narrow_m` towards one of bore `wide_m`: length 2 (D1 - D2), a
/// half angle of atan(1/4), or half of the straight it sits on where that is shorter.
Cone CalcCone(double narrow_m, double wide_m, double straight_m);

}  // namespace piperun
