#include "sim/network/head_system.h"

#include <Eigen/OrderingMethods>
#include <algorithm>

#include "base/check.h"

namespace piperun::sim {
namespace {

/// The row of every junction in the order that fills in least.
std::vector<int> FindRows(int n, const std::vector<std::pair<int, int>>& ends) {
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < n; ++i) entries.emplace_back(i, i, 1.0);
  for (const auto& [from, to] : ends) {
    if (from < n && to < n) {
      entries.emplace_back(from, to, 1.0);
      entries.emplace_back(to, from, 1.0);
    }
  }
  Eigen::SparseMatrix<double> pattern(n, n);
  pattern.setFromTriplets(entries.begin(), entries.end());
  Eigen::AMDOrdering<int>::PermutationType inverse;
  Eigen::AMDOrdering<int>()(pattern, inverse);
  const Eigen::AMDOrdering<int>::PermutationType permutation = inverse.inverse();
  return {permutation.indices().data(), permutation.indices().data() + n};
}

}  // namespace

HeadSystem::HeadSystem(int junction_count, const std::vector<std::pair<int, int>>& ends)
    : row_(FindRows(junction_count, ends)),
      junction_(junction_count),
      diagonal_(junction_count),
      places_(ends.size()),
      right_(junction_count),
      solution_(junction_count) {
  for (int i = 0; i < junction_count; ++i) junction_[row_[i]] = i;
  BuildPattern(ends);
  values_ = matrix_.valuePtr();
  factors_.analyzePattern(matrix_);
}

void HeadSystem::BuildPattern(const std::vector<std::pair<int, int>>& ends) {
  const int n = static_cast<int>(row_.size());
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < n; ++i) entries.emplace_back(i, i, 1.0);
  for (const auto& [from, to] : ends) {
    if (from >= n || to >= n) continue;
    const auto [low, high] = std::minmax(row_[from], row_[to]);
    entries.emplace_back(low, high, 0.0);
  }
  matrix_.resize(n, n);
  matrix_.setFromTriplets(entries.begin(), entries.end());
  matrix_.makeCompressed();
  for (int i = 0; i < n; ++i) diagonal_[i] = FindValue(row_[i], row_[i]);
  for (std::size_t k = 0; k < ends.size(); ++k) {
    const auto& [from, to] = ends[k];
    if (from < n) places_[k].from = diagonal_[from];
    if (to < n) places_[k].to = diagonal_[to];
    if (from < n && to < n) places_[k].off_diagonal = FindValue(row_[from], row_[to]);
  }
}

int HeadSystem::FindValue(int row, int column) const {
  const auto [low, high] = std::minmax(row, column);
  const int* begin = matrix_.innerIndexPtr() + matrix_.outerIndexPtr()[high];
  const int* end = matrix_.innerIndexPtr() + matrix_.outerIndexPtr()[high + 1];
  const int* found = std::lower_bound(begin, end, low);
  Demand(found != end && *found == low, "the pattern holds every link");
  return static_cast<int>(found - matrix_.innerIndexPtr());
}

void HeadSystem::Clear() {
  std::fill_n(values_, matrix_.nonZeros(), 0.0);
  right_.setZero();
}

bool HeadSystem::Solve() {
  factors_.factorize(matrix_);
  const auto& pivots = factors_.vectorD();
  for (Eigen::Index i = 0; i < pivots.size(); ++i) {
    if (!(pivots[i] > 0)) {
      bad_junction_ = junction_[static_cast<std::size_t>(i)];
      return false;
    }
  }
  SolveAgain();
  return true;
}

void HeadSystem::SolveAgain() { solution_ = factors_.solve(right_); }

}  // namespace piperun::sim
