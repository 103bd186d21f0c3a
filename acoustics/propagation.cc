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

struct Stretch {
  int pipe;
  double s_1_m;
  double s_2_m;
};

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
    Offer(own.from_node, {}, {source.pipe, 0, source.s_m}, -1);
    Offer(own.to_node, {}, {source.pipe, source.s_m, own.length_m}, -1);
    while (!queue_.empty()) {
      const auto [loss_Np, node] = queue_.top();
      queue_.pop();
      if (loss_Np == AtNode(paths_.nodes, node).loss_Np) Expand(node);
    }
    return std::move(paths_);
  }

 private:
  template <class T>
  static T& AtNode(std::vector<T>& items, int node) {
    return items[static_cast<std::size_t>(node)];
  }

  struct Loss {
    double whole_Np = 0;
    double local_Np = 0;
  };

  void Expand(int node) {
    const PathStep step = AtNode(paths_.nodes, node);
    for (const int i : AtNode(pipes_at_, node)) {
      const AcousticPipe& pipe = At(pipes_, i);
      const int other = pipe.from_node == node ? pipe.to_node : pipe.from_node;
      Offer(other, {step.loss_Np, step.local_Np}, {i, 0, pipe.length_m}, node);
    }
  }

  void Offer(int node, const Loss& before, const Stretch& stretch, int previous_node) {
    const AcousticPipe& pipe = At(pipes_, stretch.pipe);
    const double length_m = stretch.s_2_m - stretch.s_1_m;
    const double local_Np = CalcLocalLoss_Np(pipe, stretch.s_1_m, stretch.s_2_m);
    const double loss_Np =
        before.whole_Np + pipe.wave.Attenuation_Np_m(kPathFrequency_Hz) * length_m + local_Np;
    PathStep& best = AtNode(paths_.nodes, node);
    if (!(loss_Np < best.loss_Np)) return;
    best = {loss_Np, stretch.pipe, length_m, previous_node, before.local_Np + local_Np};
    queue_.emplace(loss_Np, node);
  }

  using Entry = std::pair<double, int>;  // loss, node: of equal losses the lower index comes first

  const std::vector<AcousticPipe>& pipes_;
  std::vector<std::vector<int>> pipes_at_;  // per node
  PathTree paths_;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue_;
};

}  // namespace

double CalcLocalLoss_Np(const AcousticPipe& pipe, double s_1_m, double s_2_m) {
  const auto [begin_m, end_m] = std::minmax(s_1_m, s_2_m);
  double loss_Np = 0;
  for (const LocalLoss& local : pipe.local_losses) {
    const double shared_m = std::min(end_m, local.s_end_m) - std::max(begin_m, local.s_begin_m);
    loss_Np += local.loss_Np_m * std::max(shared_m, 0.0);
  }
  return loss_Np;
}

PathTree FindPaths(const std::vector<AcousticPipe>& pipes, const PipePlace& source) {
  return PathSearch(pipes, source).Run();
}

Arrival FindArrival(const std::vector<AcousticPipe>& pipes, const PathTree& paths, const PipePlace& place) {
  if (place.pipe < 0) return {};
  const AcousticPipe& pipe = At(pipes, place.pipe);
  const double alpha = pipe.wave.Attenuation_Np_m(kPathFrequency_Hz);
  Arrival best;
  double least_Np = kNoWay;
  const auto offer = [&](WayIn way, double before_Np, double local_before_Np, double from_s_m) {
    const double length_m = std::abs(place.s_m - from_s_m);
    const double local_Np = CalcLocalLoss_Np(pipe, from_s_m, place.s_m);
    const double loss_Np = before_Np + alpha * length_m + local_Np;
    if (!(loss_Np < least_Np)) return;
    least_Np = loss_Np;
    best = {way, length_m, local_before_Np + local_Np};
  };
  const auto offer_from = [&](WayIn way, int node, double from_s_m) {
    const PathStep& step = paths.nodes[static_cast<std::size_t>(node)];
    offer(way, step.loss_Np, step.local_Np, from_s_m);
  };
  if (place.pipe == paths.source.pipe) offer(WayIn::kDirect, 0, 0, paths.source.s_m);
  offer_from(WayIn::kFromEnd, pipe.from_node, 0);
  offer_from(WayIn::kToEnd, pipe.to_node, pipe.length_m);
  return best;
}

double CalcPathLoss_Np(const std::vector<AcousticPipe>& pipes, const PathTree& paths, const PipePlace& place,
                       double f_Hz) {
  const Arrival arrival = FindArrival(pipes, paths, place);
  if (arrival.way == WayIn::kNone) return kNoWay;
  const AcousticPipe& last = At(pipes, place.pipe);
  double loss_Np = arrival.local_Np + arrival.length_m * last.wave.Attenuation_Np_m(f_Hz);
  if (arrival.way == WayIn::kDirect) return loss_Np;
  const int node = arrival.way == WayIn::kFromEnd ? last.from_node : last.to_node;
  WalkBack(paths, node, [&](int pipe, double length_m) {
    loss_Np += length_m * At(pipes, pipe).wave.Attenuation_Np_m(f_Hz);
  });
  return loss_Np;
}

}  // namespace piperun::acoustics
