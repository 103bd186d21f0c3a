#pragma once

#include <utility>
#include <vector>

namespace piperun::sim {

/// The symmetric positive definite equations of the global gradient algorithm (Todini & Pilati 1988): one row
/// per junction, A dH = r, A holding the conductances dq/dh of the links. Solved by A = L D L^T. The topology
/// is analysed once (Eigen's approximate minimum degree ordering, the pattern of L, and where each product of
/// the elimination goes), so that a factorisation is one pass over known places: pipe networks fill in so
/// little that this takes a third of the time of Eigen's SimplicialLDLT, which walks the elimination tree
/// anew each time.
class HeadSystem {
 public:
  /// `ends`: the nodes of every link. Nodes from `junction_count` on have given heads and no row.
  HeadSystem(int junction_count, const std::vector<std::pair<int, int>>& ends);

  void Clear();
  /// A link: how its flow follows the heads, and the flow it takes from its first node and brings to its
  /// second.
  void AddLink(int link, double conductance, double flow) {
    const Place& place = places_[link];
    lower_[place.off_diagonal] -= conductance;
    diagonal_[place.from_row] += conductance;
    diagonal_[place.to_row] += conductance;
    right_[place.from_row] -= flow;
    right_[place.to_row] += flow;
  }
  void AddDiagonal(int junction, double conductance) { diagonal_[row_[junction]] += conductance; }
  void AddRight(int junction, double excess) { right_[row_[junction]] += excess; }
  void SetRight(int junction, double excess) { right_[row_[junction]] = excess; }

  /// False when A is not positive definite; bad_junction() then tells where.
  bool Solve();
  /// With another right-hand side and the same A.
  void SolveAgain();
  double Solution(int junction) const { return right_[row_[junction]]; }
  /// Solution at the first node of a link minus that at its second; 0 where a head is given.
  double Difference(int link) const { return right_[places_[link].from_row] - right_[places_[link].to_row]; }
  int bad_junction() const { return bad_junction_; }

 private:
  /// Where a link's numbers go. Given heads share a row behind the last, and links to them a place behind L's
  /// last, which are written but never used.
  struct Place {
    int off_diagonal = 0;
    int from_row = 0;
    int to_row = 0;
  };

  void FindPattern(const std::vector<std::pair<int, int>>& ends);
  void FindTargets();
  int FindEntry(int row, int column) const;
  bool Eliminate();
  void SubstituteBack();

  int size_;
  std::vector<int> row_;           // of a junction
  std::vector<int> junction_;      // of a row
  std::vector<int> column_begin_;  // L by columns: rows below the diagonal, rising
  std::vector<int> entry_row_;
  std::vector<int> target_;  // for each product of two entries of a column, the entry it is subtracted from
  std::vector<Place> places_;
  std::vector<double> diagonal_;  // A's, then 1/D
  std::vector<double> lower_;     // A's, then L
  std::vector<double> right_;     // r, then the solution
  int bad_junction_ = -1;
};

}  // namespace piperun::sim
