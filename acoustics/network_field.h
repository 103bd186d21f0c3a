#pragma once

#include <complex>
#include <cstddef>
#include <utility>
#include <vector>

#include "acoustics/acoustic_network.h"

namespace piperun::acoustics {

class NodalAdmittance;

/// The plane waves that sources of sound in the walls of a network make everywhere in it, frequency by
/// frequency: all reflections, branches and loops (Wylie & Streeter, Fluid Transients in Systems, 1993,
/// chapter 12). With k of pipe_wave.h, e = exp(-i k L) and the admittance Yc = A Re k / (rho omega), the
/// flows into the two ends of a stretch of pipe are
///
///   q1 = Y11 p1 + Y12 p2,  q2 = Y12 p1 + Y11 p2,  Y11 = Yc (1 + e^2) / (1 - e^2),  Y12 = -2 Yc e / (1 -
///   e^2),
///
/// and in every node the flows into pipes, links and holes add up to what a source there gives off. Time
/// goes as exp(+i omega t). |e| < 1, so nothing grows with length. Sources and holes divide their pipes;
/// those within 1 um of one another or of a node share its place.
///
/// What lies further from all sources than 80 dB of loss on the way there, at the lowest frequency of an
/// octave, is left out in that octave: pipes that lead there go on for ever, and there is no sound in it.
///
/// Range: plane waves, so below the cut-on of the pipes; mean flow is left out (Mach numbers of 1e-3).
class NetworkField {
 public:
  /// Frequencies rise and are above 0; sources lie within their pipes, which are longer than 0.
  NetworkField(AcousticNetwork network, const std::vector<PipePlace>& sources,
               std::vector<double> frequencies_Hz);

  const std::vector<double>& frequencies_Hz() const { return frequencies_Hz_; }

  /// Complex pressure at a place over the volume velocity of a source, in Pa s/m3. Zero in no pipe.
  std::complex<double> Impedance_Pa_s_m3(std::size_t frequency, std::size_t source,
                                         const PipePlace& place) const;

  /// Part of a pipe between two of its ends, sources and holes.
  struct Stretch {
    int pipe = 0;
    double begin_m = 0;
    double length_m = 0;
    double local_loss_Np_m = 0;  ///< beyond that of the pipe's wave
    int from_node = 0;           ///< nodes of the network and, behind them, what divides pipes
    int to_node = 0;
  };
  std::size_t FindStretch(const PipePlace& place) const;
  std::size_t sources() const { return source_nodes_.size(); }
  std::size_t stretches() const { return stretches_.size(); }
  const Stretch& stretch(std::size_t i) const { return stretches_[i]; }

  /// The impedance in a stretch is forward exp(-i k x) + backward exp(-i k (L - x)), x from its begin.
  struct Waves {
    std::complex<double> forward, backward;
  };
  Waves FindWaves(std::size_t frequency, std::size_t source, std::size_t stretch) const;

 private:
  using Cuts = std::vector<std::pair<double, int>>;  // of a pipe: s and the node there

  /// Solutions for the frequencies of an octave, over the nodes that sound reaches.
  struct Band {
    std::size_t first_frequency = 0;
    std::vector<int> unknown_of_node;  // NodalAdmittance::kGoesOn where no sound comes
    int unknowns = 0;
    std::vector<std::complex<double>> pressures;  // by frequency, source, unknown
    int UnknownOf(int node) const { return unknown_of_node[static_cast<std::size_t>(node)]; }
  };

  const PipeWave& WaveOf(const Stretch& s) const {
    return network_.pipes[static_cast<std::size_t>(s.pipe)].wave;
  }
  std::complex<double> Wavenumber_rad_m(const Stretch& s, double f_Hz) const;
  void Divide(const std::vector<PipePlace>& sources);
  int FindOrMakeNode(const PipePlace& place, std::vector<Cuts>& cuts);
  void FindReach(Band& band) const;
  void WriteEquations(const Band& band, NodalAdmittance& equations) const;
  void Solve(std::size_t end_frequency, Band& band) const;
  const Band& BandOf(std::size_t frequency) const;

  AcousticNetwork network_;
  std::vector<double> frequencies_Hz_;
  std::vector<Stretch> stretches_;          // by pipe, then by begin
  std::vector<std::size_t> first_stretch_;  // of each pipe, and one behind the last
  std::vector<int> source_nodes_, hole_nodes_;
  int nodes_ = 0;  // of the network and, behind them, what divides pipes
  std::vector<Band> bands_;
};

}  // namespace piperun::acoustics
