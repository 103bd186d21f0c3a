#pragma once

#include <cstddef>
#include <limits>
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

/// Loss by a pipe's local losses between two places in it, in either order, in Np.
double CalcLocalLoss_Np(const AcousticPipe& pipe, double s_1_m, double s_2_m);

/// A place in a network, s along the pipe from its `from` node. Beyond its ends (a ball's centre past a dead
/// end) a pipe goes on as it is.
struct PipePlace {
  int pipe = -1;  ///< -1: in no pipe
  double s_m = 0;
};

/// Ways are compared by their loss at this frequency, so that there is one way for the whole band. Between
/// pipes of one material their order is nearly that at any other frequency, the wall's share being ~ f.
inline constexpr double kPathFrequency_Hz = 1000;

/// How the way of least loss from a source comes to a node.
struct PathStep {
  double loss_Np = std::numeric_limits<double>::infinity();  ///< of the whole way, at kPathFrequency_Hz
  int pipe = -1;                                             ///< the last one; -1: no way leads here
  double length_m = 0;                                       ///< of that pipe, as far as it is on the way
  int previous_node = -1;                                    ///< before that pipe; -1: the source lies in it
  double local_Np = 0;                                       ///< by local losses, of the whole way
};

/// The ways of least loss from a source to all nodes.
struct PathTree {
  PipePlace source;
  std::vector<PathStep> nodes;
};

/// Ways of least loss at kPathFrequency_Hz (Dijkstra, Numer. Math. 1, 269 (1959)), both directions of the
/// source's own pipe included. Of ways with equal loss the one over the node with the lower index is taken,
/// then the one through the pipe with the lower index. Pipes must have a length > 0, and the source must lie
/// within its pipe.
PathTree FindPaths(const std::vector<AcousticPipe>& pipes, const PipePlace& source);

/// Which way the sound comes: along the source's own pipe, or by an end of the listener's.
enum class WayIn : std::size_t { kDirect, kFromEnd, kToEnd, kNone };

/// The last stretch of the way to a place.
struct Arrival {
  WayIn way = WayIn::kNone;
  double length_m = 0;  ///< in the pipe of the place
  double local_Np = 0;  ///< by local losses, of the whole way
};

/// The arrival with the least loss at kPathFrequency_Hz; of equals the first of WayIn. kNone where no pipe
/// leads and for a place in no pipe.
Arrival FindArrival(const std::vector<AcousticPipe>& pipes, const PathTree& paths, const PipePlace& place);

/// Calls visit(pipe, length_m) for the stretches of the way to a node, from there back to the source.
template <class Visit>
void WalkBack(const PathTree& paths, int node, Visit visit) {
  while (node >= 0) {
    const PathStep& step = paths.nodes[static_cast<std::size_t>(node)];
    if (step.pipe >= 0) visit(step.pipe, step.length_m);
    node = step.previous_node;
  }
}

/// Loss of the plane wave on its way from a source to a place: the sum over the way's pipes of alpha(f) times
/// length and of their local losses, in Np; infinity where no way leads. The pressure falls to exp(-loss),
/// the power to exp(-2 loss). Only the way of least loss at kPathFrequency_Hz counts, whatever f. The wave
/// passes from pipe to pipe as if their impedances matched and nothing branched off: transmission,
/// reflections, sums over several ways and the near field within a diameter of the hole belong to a field of
/// the whole network and are not in it.
double CalcPathLoss_Np(const std::vector<AcousticPipe>& pipes, const PathTree& paths, const PipePlace& place,
                       double f_Hz);

}  // namespace piperun::acoustics
