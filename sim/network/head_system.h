#pragma once

#include <Eigen/SparseCholesky>
#include <utility>
#include <vector>

namespace piperun::sim {

/// The symmetric positive definite equations of the global gradient algorithm (Todini & Pilati 1988): one row
/// per junction, A dH = r, A holding the conductances dq/dh of the links. The pattern is analysed once
/// (approximate minimum degree ordering, elimination tree); after that only numbers change.
class HeadSystem {
 public:
  /// `ends`: the nodes of every link. Nodes from `junction_count` on have given heads and no row.
  HeadSystem(int junction_count, const std::vector<std::pair<int, int>>& ends);
  HeadSystem(const HeadSystem&) = delete;  // holds the place of its own values
  HeadSystem& operator=(const HeadSystem&) = delete;

  void Clear();
  void AddLink(int link, double conductance) {
    const Place& place = places_[link];
    if (place.off_diagonal >= 0) values_[place.off_diagonal] -= conductance;
    if (place.from >= 0) values_[place.from] += conductance;
    if (place.to >= 0) values_[place.to] += conductance;
  }
  void AddDiagonal(int junction, double conductance) { values_[diagonal_[junction]] += conductance; }
  void AddRight(int junction, double excess) { right_[row_[junction]] += excess; }

  void SetRight(int junction, double excess) { right_[row_[junction]] = excess; }

  /// False when A is not positive definite; bad_junction() then tells where.
  bool Solve();
  /// With another right-hand side and the same A.
  void SolveAgain();
  double Solution(int junction) const { return solution_[row_[junction]]; }
  int bad_junction() const { return bad_junction_; }

 private:
  using Matrix = Eigen::SparseMatrix<double>;
  /// Where a link's conductance goes among the values of A; -1: nowhere.
  struct Place {
    int off_diagonal = -1;
    int from = -1;
    int to = -1;
  };

  void BuildPattern(const std::vector<std::pair<int, int>>& ends);
  int FindValue(int row, int column) const;

  std::vector<int> row_;       // of a junction
  std::vector<int> junction_;  // of a row
  std::vector<int> diagonal_;  // value index per junction
  std::vector<Place> places_;
  Matrix matrix_;  // upper triangle, rows permuted
  double* values_ = nullptr;
  Eigen::SimplicialLDLT<Matrix, Eigen::Upper, Eigen::NaturalOrdering<int>> factors_;
  Eigen::VectorXd right_;
  Eigen::VectorXd solution_;
  int bad_junction_ = -1;
};

}  // namespace piperun::sim
