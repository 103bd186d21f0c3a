#pragma once

#include <vector>

#include "acoustics/pipe_wave.h"

namespace piperun::acoustics {

/// A stretch of a pipe where sound of all frequencies loses more than by the pipe's wave.
struct LocalLoss {
  double s_begin_m = 0;
  double s_end_m = 0;
  double loss_Np_m = 0;
};

/// One pipe of a network as sound sees it: what it joins and the wave it carries.
struct AcousticPipe {
  int from_node = 0;  ///< nodes are numbered from 0
  int to_node = 0;
  double length_m = 0;
  PipeWave wave;
  std::vector<LocalLoss> local_losses{};
};

/// A place in a network, s along the pipe from its `from` node. Beyond its ends (a ball's centre past a dead
/// end) a pipe goes on as it is.
struct PipePlace {
  int pipe = -1;  ///< -1: in no pipe
  double s_m = 0;
};

/// What a node is to sound, besides the pipes that meet in it.
enum class NodeEnd {
  kClosed,     ///< nothing else: one pipe ends dead (reflection +1), several share the flow
  kOpenWater,  ///< a reservoir or tank: p = 0 (reflection -1)
  kGoesOn,     ///< its one pipe goes on for ever: no reflection
};

/// A valve or pump between two nodes, small against the wavelength: what flows is (p1 - p2) / R. Of a
/// head loss that grows with the square of the flow, R = d(dP)/dQ = 2 dP / Q.
struct LumpedLink {
  int from_node = 0;
  int to_node = 0;
  double resistance_Pa_s_m3 = 0;
};

/// An open hole: it takes the flow Y p, Y = dQ/d(dP) = Q / (2 dP) of an orifice.
struct ShuntHole {
  PipePlace place;
  double admittance_m3_s_Pa = 0;
};

struct AcousticNetwork {
  std::vector<AcousticPipe> pipes;
  std::vector<NodeEnd> ends;  ///< by node; nodes beyond the list are kClosed
  std::vector<LumpedLink> links;
  std::vector<ShuntHole> holes;
};

}  // namespace piperun::acoustics
