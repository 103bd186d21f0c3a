#include "sim/network/head_system.h"

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>
#include <algorithm>
#include <iterator>

#include "base/check.h"

namespace piperun::sim {
namespace {

/// The row of every junction in the order that fills in least.
std::vector<int> FindRows(int n, const std::vector<std::pair<int, int>>& ends) {
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(static_cast<std::size_t>(n) + 2 * ends.size());
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

void SortUnique(std::vector<int>& values) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
}

}  // namespace

HeadSystem::HeadSystem(int junction_count, const std::vector<std::pair<int, int>>& ends)
    : size_(junction_count),
      row_(FindRows(junction_count, ends)),
      junction_(row_.size()),
      places_(ends.size()),
      diagonal_(row_.size() + 1),
      right_(row_.size() + 1) {
  for (int i = 0; i < size_; ++i) junction_[row_[i]] = i;
  FindPattern(ends);
  FindTargets();
  lower_.resize(entry_row_.size() + 1);
  for (std::size_t k = 0; k < ends.size(); ++k) {
    const int from = ends[k].first < size_ ? row_[ends[k].first] : size_;
    const int to = ends[k].second < size_ ? row_[ends[k].second] : size_;
    const bool inside = from < size_ && to < size_;
    places_[k] = {
        inside ? FindEntry(std::max(from, to), std::min(from, to)) : static_cast<int>(entry_row_.size()),
        from, to};
  }
}

/// Column k of L: the neighbours of k that come later, and what its children in the elimination tree hand on.
void HeadSystem::FindPattern(const std::vector<std::pair<int, int>>& ends) {
  std::vector<std::vector<int>> columns(row_.size());
  for (const auto& [from, to] : ends) {
    if (from >= size_ || to >= size_) continue;
    const auto [low, high] = std::minmax(row_[from], row_[to]);
    columns[low].push_back(high);
  }
  column_begin_ = {0};
  for (int k = 0; k < size_; ++k) {
    std::vector<int>& column = columns[k];
    SortUnique(column);
    entry_row_.insert(entry_row_.end(), column.begin(), column.end());
    column_begin_.push_back(static_cast<int>(entry_row_.size()));
    if (column.empty()) continue;
    std::vector<int>& parent = columns[column.front()];
    parent.insert(parent.end(), std::next(column.begin()), column.end());
  }
}

void HeadSystem::FindTargets() {
  for (int k = 0; k < size_; ++k) {
    for (int p = column_begin_[k]; p < column_begin_[k + 1]; ++p) {
      for (int q = p + 1; q < column_begin_[k + 1]; ++q)
        target_.push_back(FindEntry(entry_row_[q], entry_row_[p]));
    }
  }
}

int HeadSystem::FindEntry(int row, int column) const {
  const auto begin = entry_row_.begin() + column_begin_[column],
             end = entry_row_.begin() + column_begin_[column + 1];
  const auto found = std::lower_bound(begin, end, row);
  Demand(found != end && *found == row, "the pattern of L holds every link and every fill-in");
  return static_cast<int>(found - entry_row_.begin());
}

void HeadSystem::Clear() {
  std::fill(diagonal_.begin(), diagonal_.end(), 0.0);
  std::fill(lower_.begin(), lower_.end(), 0.0);
  std::fill(right_.begin(), right_.end(), 0.0);
}

/// Eliminates column after column, A_ij -= A_ik A_jk / d_k, and with it the right-hand side, r_i -= l_ik r_k.
bool HeadSystem::Eliminate() {
  const int* target = target_.data();
  int p = 0;
  for (int k = 0; k < size_; ++k) {
    if (!(diagonal_[k] > 0)) {
      bad_junction_ = junction_[k];
      return false;
    }
    const double inverse = diagonal_[k] = 1 / diagonal_[k];
    const double right = right_[k];
    for (const int end = column_begin_[k + 1]; p < end; ++p) {
      const double value = lower_[p], l = value * inverse;
      diagonal_[entry_row_[p]] -= l * value;
      right_[entry_row_[p]] -= l * right;
      for (int q = p + 1; q < end; ++q) lower_[*target++] -= l * lower_[q];
      lower_[p] = l;
    }
  }
  return true;
}

void HeadSystem::SubstituteBack() {
  int p = column_begin_[size_];
  for (int k = size_ - 1; k >= 0; --k) {
    double value = right_[k] * diagonal_[k];
    for (const int begin = column_begin_[k]; p > begin;) {
      --p;
      value -= lower_[p] * right_[entry_row_[p]];
    }
    right_[k] = value;
  }
  right_[size_] = 0;
}

bool HeadSystem::Solve() {
  if (!Eliminate()) return false;
  SubstituteBack();
  return true;
}

void HeadSystem::SolveAgain() {
  for (int k = 0; k < size_; ++k) {
    const double value = right_[k];
    for (int p = column_begin_[k]; p < column_begin_[k + 1]; ++p) right_[entry_row_[p]] -= lower_[p] * value;
  }
  SubstituteBack();
}

}  // namespace piperun::sim
