#include "acoustics/network_field.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <queue>
#include <utility>

#include "acoustics/nodal_admittance.h"
#include "base/check.h"

namespace piperun::acoustics {
namespace {

using Complex = std::complex<double>;

constexpr double kSamePlace_m = 1e-6;
constexpr double kReach_Np = 80 / 8.685889638;
constexpr double kOctave = 2;

std::size_t CountNodes(const AcousticNetwork& network) {
  int last = static_cast<int>(network.ends.size()) - 1;
  for (const AcousticPipe& pipe : network.pipes) {
    Demand(pipe.from_node >= 0 && pipe.to_node >= 0, "nodes are numbered from 0");
    Demand(pipe.length_m > kSamePlace_m, "an acoustic pipe has a length");
    last = std::max({last, pipe.from_node, pipe.to_node});
  }
  for (const LumpedLink& link : network.links) last = std::max({last, link.from_node, link.to_node});
  return static_cast<std::size_t>(last + 1);
}

double FindLocalLoss_Np_m(const AcousticPipe& pipe, double s_m) {
  double loss_Np_m = 0;
  for (const LocalLoss& local : pipe.local_losses) {
    if (local.s_begin_m < s_m && s_m < local.s_end_m) loss_Np_m += local.loss_Np_m;
  }
  return loss_Np_m;
}

/// Least losses on the way from any source to all nodes (Dijkstra, Numer. Math. 1, 269 (1959)).
class LossSearch {
 public:
  explicit LossSearch(std::size_t nodes)
      : ways_(nodes), loss_Np_(nodes, std::numeric_limits<double>::infinity()) {}

  void AddWay(int a, int b, double loss_Np) {
    ways_[static_cast<std::size_t>(a)].push_back({b, loss_Np});
    ways_[static_cast<std::size_t>(b)].push_back({a, loss_Np});
  }
  void AddSource(int node) { Offer(node, 0); }

  std::vector<double> Run() {
    while (!queue_.empty()) {
      const auto [loss_Np, node] = queue_.top();
      queue_.pop();
      if (loss_Np > loss_Np_[static_cast<std::size_t>(node)]) continue;
      for (const auto& way : ways_[static_cast<std::size_t>(node)]) Offer(way.node, loss_Np + way.loss_Np);
    }
    return std::move(loss_Np_);
  }

 private:
  struct Way {
    int node;
    double loss_Np;
  };
  void Offer(int node, double loss_Np) {
    double& least = loss_Np_[static_cast<std::size_t>(node)];
    if (!(loss_Np < least)) return;
    least = loss_Np;
    queue_.emplace(loss_Np, node);
  }

  std::vector<std::vector<Way>> ways_;
  std::vector<double> loss_Np_;
  std::priority_queue<std::pair<double, int>, std::vector<std::pair<double, int>>, std::greater<>> queue_;
};

}  // namespace

NetworkField::NetworkField(AcousticNetwork network, const std::vector<PipePlace>& sources,
                           std::vector<double> frequencies_Hz)
    : network_(std::move(network)), frequencies_Hz_(std::move(frequencies_Hz)) {
  Demand(std::is_sorted(frequencies_Hz_.begin(), frequencies_Hz_.end()), "frequencies rise");
  Demand(frequencies_Hz_.empty() || frequencies_Hz_.front() > 0, "a wave has a frequency above zero");
  Divide(sources);
  for (std::size_t i = 0; i < frequencies_Hz_.size();) {
    Band& band = bands_.emplace_back();
    band.first_frequency = i;
    FindReach(band);
    const double end_Hz = kOctave * frequencies_Hz_[i];
    const auto end = std::lower_bound(frequencies_Hz_.begin(), frequencies_Hz_.end(), end_Hz);
    i = static_cast<std::size_t>(end - frequencies_Hz_.begin());
    Solve(i, band);
  }
}

void NetworkField::Divide(const std::vector<PipePlace>& sources) {
  nodes_ = static_cast<int>(CountNodes(network_));
  std::vector<Cuts> cuts(network_.pipes.size());
  for (const PipePlace& place : sources) source_nodes_.push_back(FindOrMakeNode(place, cuts));
  for (const ShuntHole& hole : network_.holes) hole_nodes_.push_back(FindOrMakeNode(hole.place, cuts));
  for (std::size_t i = 0; i < cuts.size(); ++i) {
    for (const LocalLoss& local : network_.pipes[i].local_losses) {
      FindOrMakeNode({static_cast<int>(i), local.s_begin_m}, cuts);
      FindOrMakeNode({static_cast<int>(i), local.s_end_m}, cuts);
    }
  }
  for (std::size_t i = 0; i < cuts.size(); ++i) {
    const AcousticPipe& pipe = network_.pipes[i];
    first_stretch_.push_back(stretches_.size());
    std::sort(cuts[i].begin(), cuts[i].end());
    cuts[i].emplace_back(pipe.length_m, pipe.to_node);
    double begin_m = 0;
    int from = pipe.from_node;
    for (const auto& [s_m, node] : cuts[i]) {
      const double local_Np_m = FindLocalLoss_Np_m(pipe, 0.5 * (begin_m + s_m));
      stretches_.push_back({static_cast<int>(i), begin_m, s_m - begin_m, local_Np_m, from, node});
      begin_m = s_m;
      from = node;
    }
  }
  first_stretch_.push_back(stretches_.size());
}

int NetworkField::FindOrMakeNode(const PipePlace& place, std::vector<Cuts>& cuts) {
  const auto i = static_cast<std::size_t>(place.pipe);
  Demand(place.pipe >= 0 && i < cuts.size(), "the acoustic network has that pipe");
  const AcousticPipe& pipe = network_.pipes[i];
  Demand(place.s_m >= 0 && place.s_m <= pipe.length_m, "a source or hole lies within its pipe");
  if (place.s_m < kSamePlace_m) return pipe.from_node;
  if (pipe.length_m - place.s_m < kSamePlace_m) return pipe.to_node;
  for (const auto& [s_m, node] : cuts[i]) {
    if (std::abs(s_m - place.s_m) < kSamePlace_m) return node;
  }
  cuts[i].emplace_back(place.s_m, nodes_);
  return nodes_++;
}

/// Which nodes sound of the band's lowest frequency comes to.
void NetworkField::FindReach(Band& band) const {
  LossSearch search(static_cast<std::size_t>(nodes_));
  const double f_Hz = frequencies_Hz_[band.first_frequency];
  for (const Stretch& s : stretches_)
    search.AddWay(s.from_node, s.to_node,
                  s.length_m * (WaveOf(s).Attenuation_Np_m(f_Hz) + s.local_loss_Np_m));
  for (const LumpedLink& link : network_.links) search.AddWay(link.from_node, link.to_node, 0);
  for (const int node : source_nodes_) search.AddSource(node);
  const std::vector<double> loss_Np = search.Run();
  for (std::size_t node = 0; node < loss_Np.size(); ++node) {
    const bool open = node < network_.ends.size() && network_.ends[node] == NodeEnd::kOpenWater;
    const bool reached = loss_Np[node] < kReach_Np;
    band.unknown_of_node.push_back(open      ? NodalAdmittance::kOpenWater
                                   : reached ? band.unknowns++
                                             : NodalAdmittance::kGoesOn);
  }
}

void NetworkField::WriteEquations(const Band& band, NodalAdmittance& equations) const {
  for (const Stretch& s : stretches_)
    equations.AddPipe(band.UnknownOf(s.from_node), band.UnknownOf(s.to_node), WaveOf(s), s.local_loss_Np_m,
                      s.length_m);
  for (const LumpedLink& link : network_.links)
    equations.AddLink(band.UnknownOf(link.from_node), band.UnknownOf(link.to_node),
                      1 / link.resistance_Pa_s_m3);
  for (std::size_t i = 0; i < hole_nodes_.size(); ++i)
    equations.AddShunt(band.UnknownOf(hole_nodes_[i]), network_.holes[i].admittance_m3_s_Pa);
  for (std::size_t node = 0; node < network_.ends.size(); ++node) {
    if (network_.ends[node] != NodeEnd::kGoesOn) continue;
    const auto ends_here = [&](const AcousticPipe& pipe) {
      return pipe.from_node == static_cast<int>(node) || pipe.to_node == static_cast<int>(node);
    };
    const auto& pipes = network_.pipes;
    Demand(std::count_if(pipes.begin(), pipes.end(), ends_here) == 1, "a pipe that goes on ends alone");
    const AcousticPipe& pipe = *std::find_if(pipes.begin(), pipes.end(), ends_here);
    equations.AddOutlet(band.UnknownOf(static_cast<int>(node)), pipe.wave);
  }
  equations.Close();
}

void NetworkField::Solve(std::size_t end_frequency, Band& band) const {
  NodalAdmittance equations(band.unknowns);
  WriteEquations(band, equations);
  const auto sources = static_cast<Eigen::Index>(source_nodes_.size());
  Eigen::MatrixXcd flows = Eigen::MatrixXcd::Zero(band.unknowns, sources);
  for (Eigen::Index i = 0; i < sources; ++i) {
    const int unknown = band.UnknownOf(source_nodes_[static_cast<std::size_t>(i)]);
    if (unknown >= 0) flows(unknown, i) = 1;
  }
  for (std::size_t i = band.first_frequency; i < end_frequency; ++i) {
    const Eigen::MatrixXcd pressures = equations.Solve(frequencies_Hz_[i], flows);
    band.pressures.insert(band.pressures.end(), pressures.data(), pressures.data() + pressures.size());
  }
}

const NetworkField::Band& NetworkField::BandOf(std::size_t frequency) const {
  Demand(frequency < frequencies_Hz_.size(), "the field has that frequency");
  const auto after = [](std::size_t f, const Band& band) { return f < band.first_frequency; };
  return *std::prev(std::upper_bound(bands_.begin(), bands_.end(), frequency, after));
}

Complex NetworkField::Wavenumber_rad_m(const Stretch& s, double f_Hz) const {
  return WaveOf(s).Wavenumber_rad_m(f_Hz) - Complex(0, s.local_loss_Np_m);
}

std::size_t NetworkField::FindStretch(const PipePlace& place) const {
  const auto i = static_cast<std::size_t>(place.pipe);
  Demand(place.pipe >= 0 && i < network_.pipes.size(), "the acoustic network has that pipe");
  std::size_t stretch = first_stretch_[i];
  while (stretch + 1 < first_stretch_[i + 1] && place.s_m > stretches_[stretch + 1].begin_m) ++stretch;
  return stretch;
}

NetworkField::Waves NetworkField::FindWaves(std::size_t frequency, std::size_t source,
                                            std::size_t stretch) const {
  const Stretch& s = stretches_[stretch];
  const Band& band = BandOf(frequency);
  const int from = band.UnknownOf(s.from_node), to = band.UnknownOf(s.to_node);
  const std::size_t column = (frequency - band.first_frequency) * source_nodes_.size() + source;
  const Complex* pressures = band.pressures.data() + column * static_cast<std::size_t>(band.unknowns);
  const Complex p1 = from >= 0 ? pressures[from] : Complex(0), p2 = to >= 0 ? pressures[to] : Complex(0);
  if (from == NodalAdmittance::kGoesOn || to == NodalAdmittance::kGoesOn) return {p1, p2};
  const Complex e = std::exp(Complex(0, -1) * Wavenumber_rad_m(s, frequencies_Hz_[frequency]) * s.length_m);
  return {(p1 - p2 * e) / (1.0 - e * e), (p2 - p1 * e) / (1.0 - e * e)};
}

Complex NetworkField::Impedance_Pa_s_m3(std::size_t frequency, std::size_t source,
                                        const PipePlace& place) const {
  if (place.pipe < 0) return 0;
  const std::size_t stretch = FindStretch(place);
  const Waves waves = FindWaves(frequency, source, stretch);
  const Stretch& s = stretches_[stretch];
  const Complex ik = Complex(0, 1) * Wavenumber_rad_m(s, frequencies_Hz_[frequency]);
  const double x_m = place.s_m - s.begin_m;
  return waves.forward * std::exp(-ik * x_m) + waves.backward * std::exp(-ik * (s.length_m - x_m));
}

}  // namespace piperun::acoustics
