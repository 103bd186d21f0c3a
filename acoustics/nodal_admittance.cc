#include "acoustics/nodal_admittance.h"

#include <algorithm>

#include "base/check.h"

namespace piperun::acoustics {

using Complex = std::complex<double>;

void NodalAdmittance::AddPipe(int a, int b, const PipeWave& wave, double local_loss_Np_m, double length_m) {
  pipes_.push_back({a, b, &wave, local_loss_Np_m, length_m, nullptr, nullptr, nullptr, nullptr});
}

void NodalAdmittance::AddLink(int a, int b, double admittance_m3_s_Pa) {
  AddConstant(a, a, admittance_m3_s_Pa);
  AddConstant(b, b, admittance_m3_s_Pa);
  AddConstant(a, b, -admittance_m3_s_Pa);
  AddConstant(b, a, -admittance_m3_s_Pa);
}

void NodalAdmittance::AddShunt(int a, double admittance_m3_s_Pa) { AddConstant(a, a, admittance_m3_s_Pa); }

void NodalAdmittance::AddOutlet(int a, const PipeWave& wave) { AddPipe(a, kGoesOn, wave, 0, 0); }

void NodalAdmittance::AddConstant(int row, int column, double admittance) {
  if (row >= 0 && column >= 0) constants_.push_back({row, column, admittance});
}

void NodalAdmittance::Close() {
  std::vector<Eigen::Triplet<Complex>> triplets;
  for (const Entry& e : constants_) triplets.emplace_back(e.row, e.column, Complex(e.admittance));
  const auto visit_places = [this](auto visit) {
    for (PipeEntry& p : pipes_) {
      if (p.a >= 0) visit(p.a, p.a, p.aa);
      if (p.b >= 0) visit(p.b, p.b, p.bb);
      if (p.a >= 0 && p.b >= 0) visit(p.a, p.b, p.ab), visit(p.b, p.a, p.ba);
    }
  };
  visit_places([&](int row, int column, Complex*) { triplets.emplace_back(row, column, Complex(0)); });
  matrix_.resize(unknowns_, unknowns_);
  matrix_.setFromTriplets(triplets.begin(), triplets.end());
  visit_places([this](int row, int column, Complex*& place) { place = &matrix_.coeffRef(row, column); });
  constant_values_.assign(matrix_.valuePtr(), matrix_.valuePtr() + matrix_.nonZeros());
  lu_.analyzePattern(matrix_);
}

void NodalAdmittance::Fill(double f_Hz) {
  std::copy(constant_values_.begin(), constant_values_.end(), matrix_.valuePtr());
  for (const PipeEntry& pipe : pipes_) {
    const double yc = 1 / pipe.wave->CharacteristicImpedance_Pa_s_m3(f_Hz);
    const bool ends = pipe.a != kGoesOn && pipe.b != kGoesOn;
    const Complex k_1_m = pipe.wave->Wavenumber_rad_m(f_Hz) - Complex(0, pipe.local_loss_Np_m);
    const Complex e = ends ? std::exp(Complex(0, -1) * k_1_m * pipe.length_m) : Complex(0);
    const Complex y11 = yc * (1.0 + e * e) / (1.0 - e * e), y12 = -2 * yc * e / (1.0 - e * e);
    if (pipe.aa) *pipe.aa += y11;
    if (pipe.bb) *pipe.bb += y11;
    if (pipe.ab) *pipe.ab += y12, *pipe.ba += y12;
  }
}

Eigen::MatrixXcd NodalAdmittance::Solve(double f_Hz, const Eigen::MatrixXcd& flows) {
  Fill(f_Hz);
  lu_.factorize(matrix_);
  Demand(lu_.info() == Eigen::Success, "every wave is damped, so a network's equations can be solved");
  return lu_.solve(flows);
}

}  // namespace piperun::acoustics
