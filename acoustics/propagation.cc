#include "acoustics/propagation.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <queue>
#include <utility>

#include "base/check.h"

namespace piperun::acoustics {
namespace {

constexpr double kNoWay = std::numeric_limits<double>::infinity();

const AcousticPipe& At(const std::vector<AcousticPipe>& pipes, int pipe) {
  Demand(pipe >= 0 && static_cast<std::size_t>(pipe) < pipes.size(), "the acoustic network has that pipe");
  return pipes[static_cast<std::size_t>(pipe)];
}

std::size_t CountNodes(const std::vector<AcousticPipe>& pipes) {
  int last = -1;
  for (const AcousticPipe& pipe : pipes) {
    Demand(pipe.from_node >= 0 && pipe.to_node >= 0, "nodes are numbered from 0");
    Demand(pipe.length_m > 0, "an acoustic pipe has a length");
    last = std::max({last, pipe.from_node, pipe.to_node});
  }
  return static_cast<std::size_t>(last + 1);
}

/// Dijkstra's search. The queue may hold a node several times; only its least loss counts.
class PathSearch {
 public:
  PathSearch(const std::vector<AcousticPipe>& pipes, const PipePlace& source)
      : pipes_(pipes), pipes_at_(CountNodes(pipes)) {
    paths_.source = source;
    paths_.nodes.resize(pipes_at_.size());
    for (std::size_t i = 0; i < pipes.size(); ++i) {
      AtNode(pipes_at_, pipes[i].from_node).push_back(static_cast<int>(i));
      AtNode(pipes_at_, pipes[i].to_node).push_back(static_cast<int>(i));
    }
  }

  PathTree Run() {
    const PipePlace& source = paths_.source;
    const AcousticPipe& own = At(pipes_, source.pipe);
    Demand(source.s_m >= 0 && source.s_m <= own.length_m, "a sound source lies within its pipe");
    Offer(own.from_node, 0, source.pipe, source.s_m, -1);
    Offer(own.to_node, 0, source.pipe, own.length_m - source.s_m, -1);
    while (!queue_.empty()) {
      const auto [loss_Np, node] = queue_.top();
      queue_.pop();
      if (loss_Np == AtNode(paths_.nodes, node).loss_Np) Expand(node, loss_Np);
    }
    return std::move(paths_);
  }

 private:
  template <class T>
  static T& AtNode(std::vector<T>& items, int node) {
    return items[static_cast<std::size_t>(node)];
  }

  void Expand(int node, double loss_Np) {
    for (const int i : AtNode(pipes_at_, node)) {
      const AcousticPipe& pipe = At(pipes_, i);
      const int other = pipe.from_node == node ? pipe.to_node : pipe.from_node;
      Offer(other, loss_Np, i, pipe.length_m, node);
    }
  }

  void Offer(int node, double loss_before_Np, int pipe, double length_m, int previous_node) {
    const double alpha = At(pipes_, pipe).wave.Attenuation_Np_m(kPathFrequency_Hz);
    const double loss_Np = loss_before_Np + alpha * length_m;
    PathStep& best = AtNode(paths_.nodes, node);
    if (!(loss_Np < best.loss_Np)) return;
    best = {loss_Np, pipe, length_m, previous_node};
    queue_.emplace(loss_Np, node);
  }

  using Entry = std::pair<double, int>;  // loss, node: of equal losses the lower index comes first

  const std::vector<AcousticPipe>& pipes_;
  std::vector<std::vector<int>> pipes_at_;  // per node
  PathTree paths_;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue_;
};

}  // namespace

PathTree FindPaths(const std::vector<AcousticPipe>& pipes, const PipePlace& source) {
  return PathSearch(pipes, source).Run();
}

Arrival FindArrival(const std::vector<AcousticPipe>& pipes, const PathTree& paths, const PipePlace& place) {
  if (place.pipe < 0) return {};
  const AcousticPipe& pipe = At(pipes, place.pipe);
  const double alpha = pipe.wave.Attenuation_Np_m(kPathFrequency_Hz);
  Arrival best;
  double least_Np = kNoWay;
  const auto offer = [&](WayIn way, double loss_before_Np, double length_m) {
    const double loss_Np = loss_before_Np + alpha * length_m;
    if (!(loss_Np < least_Np)) return;
    least_Np = loss_Np;
    best = {way, length_m};
  };
  const auto loss_at = [&](int node) { return paths.nodes[static_cast<std::size_t>(node)].loss_Np; };
  if (place.pipe == paths.source.pipe) offer(WayIn::kDirect, 0, std::abs(place.s_m - paths.source.s_m));
  offer(WayIn::kFromEnd, loss_at(pipe.from_node), std::abs(place.s_m));
  offer(WayIn::kToEnd, loss_at(pipe.to_node), std::abs(pipe.length_m - place.s_m));
  return best;
}

double CalcPathLoss_Np(const std::vector<AcousticPipe>& pipes, const PathTree& paths, const PipePlace& place,
                       double f_Hz) {
  const Arrival arrival = FindArrival(pipes, paths, place);
  if (arrival.way == WayIn::kNone) return kNoWay;
  const AcousticPipe& last = At(pipes, place.pipe);
  double loss_Np = arrival.length_m * last.wave.Attenuation_Np_m(f_Hz);
  if (arrival.way == WayIn::kDirect) return loss_Np;
  const int node = arrival.way == WayIn::kFromEnd ? last.from_node : last.to_node;
  WalkBack(paths, node, [&](int pipe, double length_m) {
    loss_Np += length_m * At(pipes, pipe).wave.Attenuation_Np_m(f_Hz);
  });
  return loss_Np;
}

}  // namespace piperun::acoustics
