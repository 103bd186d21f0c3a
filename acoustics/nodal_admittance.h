#pragma once

#include <Eigen/SparseCore>
#include <Eigen/SparseLU>
#include <complex>
#include <vector>

#include "acoustics/pipe_wave.h"

namespace piperun::acoustics {

/// The equations Y p = q of a network's nodes (network_field.h), one frequency after the other.
class NodalAdmittance {
 public:
  static constexpr int kOpenWater = -1;  ///< a node with p = 0
  static constexpr int kGoesOn = -2;     ///< no node: the pipe does not end

  explicit NodalAdmittance(int unknowns) : unknowns_(unknowns) {}

  /// Between unknowns, or ends that are none of them.
  void AddPipe(int a, int b, const PipeWave& wave, double local_loss_Np_m, double length_m);
  void AddLink(int a, int b, double admittance_m3_s_Pa);
  void AddShunt(int a, double admittance_m3_s_Pa);
  /// A pipe that begins here and does not end.
  void AddOutlet(int a, const PipeWave& wave);
  /// No more of them.
  void Close();

  /// Pressures at the unknowns, one column for each of `flows`.
  Eigen::MatrixXcd Solve(double f_Hz, const Eigen::MatrixXcd& flows);

 private:
  struct Entry {
    int row, column;
    double admittance;
  };
  struct PipeEntry {
    int a, b;
    const PipeWave* wave;
    double local_loss_Np_m, length_m;
    std::complex<double>*aa, *ab, *ba, *bb;  // in the matrix; nullptr where an end is no unknown
  };

  void AddConstant(int row, int column, double admittance);
  void Fill(double f_Hz);

  int unknowns_;
  std::vector<Entry> constants_;
  std::vector<PipeEntry> pipes_;
  Eigen::SparseMatrix<std::complex<double>> matrix_;
  std::vector<std::complex<double>> constant_values_;
  Eigen::SparseLU<Eigen::SparseMatrix<std::complex<double>>> lu_;
};

}  // namespace piperun::acoustics
