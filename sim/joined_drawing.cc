#include "sim/joined_drawing.h"

namespace piperun::sim {
namespace {

Vector3d EndPoint_W(const Network& network, PipeEnd end) {
  const Pipe& pipe = network.pipe(end.pipe);
  return pipe.Eval(pipe.EndS_m(end.at_to)).p_W;
}

/// What brings this end of a pipe to the end of `fixed` at the same node, if there is one.
std::optional<Vector3d> FindShift_W(const Network& network, int fixed, PipeEnd end) {
  for (const bool at_to : {false, true}) {
    const PipeEnd other{fixed, at_to};
    if (network.NodeAt(other) == network.NodeAt(end)) {
      return EndPoint_W(network, other) - EndPoint_W(network, end);
    }
  }
  return std::nullopt;
}

}  // namespace

JoinedDrawing::JoinedDrawing(const Network& network, int fixed, int pipe)
    : middle_m_(0.5 * network.pipe(pipe).length_m),
      shifts_W_{FindShift_W(network, fixed, {pipe, false}), FindShift_W(network, fixed, {pipe, true})} {}

Vector3d JoinedDrawing::Shift_W(double s_m) const {
  const std::size_t near = s_m > middle_m_;
  return shifts_W_[near].value_or(shifts_W_[1 - near].value_or(Vector3d::Zero()));
}

}  // namespace piperun::sim
