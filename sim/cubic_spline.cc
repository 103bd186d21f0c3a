#include "sim/cubic_spline.h"

#include <algorithm>
#include <cstddef>

#include "base/check.h"

namespace piperun::sim {
namespace {

/// Solves a tridiagonal system with vector right-hand sides in place (Thomas); the answer is in `rhs`.
void SolveTridiagonal(const std::vector<double>& lower, std::vector<double> diagonal,
                      const std::vector<double>& upper, std::vector<Vector3d>& rhs) {
  const std::size_t n = rhs.size();
  for (std::size_t i = 1; i < n; ++i) {
    const double factor = lower[i] / diagonal[i - 1];
    diagonal[i] -= factor * upper[i - 1];
    rhs[i] -= factor * rhs[i - 1];
  }
  rhs[n - 1] /= diagonal[n - 1];
  for (std::size_t i = n - 1; i-- > 0;) rhs[i] = (rhs[i] - upper[i] * rhs[i + 1]) / diagonal[i];
}

/// Second derivatives M at the knots t of a spline from rest to rest. Knots 1 and n-1 are free: as velocity
/// and acceleration vanish at knot 0, x_1 = x_0 + h_0^2 M_1 / 6, and likewise from the end, so every knot
/// reads x_i = c_i + g_i M_i with g = 0 at the others. Continuity of the first derivative at knot i:
///   h_{i-1} M_{i-1} + 2 (h_{i-1} + h_i) M_i + h_i M_{i+1} = 6 [(x_{i+1} - x_i) / h_i - (x_i - x_{i-1}) /
///   h_{i-1}]
std::vector<Vector3d> CalcSecondDerivatives(const std::vector<double>& t, const std::vector<Vector3d>& c) {
  const std::size_t n = t.size() - 1;
  std::vector<double> h(n), g(n + 1, 0.0);
  for (std::size_t i = 0; i < n; ++i) h[i] = t[i + 1] - t[i];
  g[1] = h[0] * h[0] / 6;
  g[n - 1] = h[n - 1] * h[n - 1] / 6;

  std::vector<double> lower(n - 1), diagonal(n - 1), upper(n - 1);
  std::vector<Vector3d> m(n - 1);
  for (std::size_t i = 1; i < n; ++i) {
    lower[i - 1] = h[i - 1] / 6 - g[i - 1] / h[i - 1];
    diagonal[i - 1] = (h[i - 1] + h[i]) / 3 + g[i] / h[i - 1] + g[i] / h[i];
    upper[i - 1] = h[i] / 6 - g[i + 1] / h[i];
    m[i - 1] = (c[i + 1] - c[i]) / h[i] - (c[i] - c[i - 1]) / h[i - 1];
  }
  SolveTridiagonal(lower, diagonal, upper, m);
  m.insert(m.begin(), Vector3d::Zero());
  m.push_back(Vector3d::Zero());
  return m;
}

}  // namespace

CubicSpline::CubicSpline(const std::vector<double>& times_s, const std::vector<Vector3d>& points) {
  Demand(!points.empty() && times_s.size() == points.size(), "a spline has as many points as times");
  const std::size_t last = points.size() - 1;
  for (std::size_t i = 0; i < last;) {
    if (points[i] == points[i + 1]) {
      AppendRest(times_s[i], points[i]);
      ++i;
      continue;
    }
    std::size_t end = i + 1;
    while (end < last && points[end] != points[end + 1]) ++end;
    const auto first = static_cast<std::ptrdiff_t>(i), past = static_cast<std::ptrdiff_t>(end) + 1;
    AppendStretch({times_s.begin() + first, times_s.begin() + past},
                  {points.begin() + first, points.begin() + past});
    i = end;
  }
  AppendRest(times_s[last], points[last]);
}

void CubicSpline::AppendRest(double begin_s, const Vector3d& x) {
  knots_s_.push_back(begin_s);
  pieces_.push_back({x, Vector3d::Zero(), Vector3d::Zero(), Vector3d::Zero()});
}

/// Knots of one moving stretch. A free knot stands in `c` with its outer neighbour's point, see above.
void CubicSpline::AppendStretch(std::vector<double> t, std::vector<Vector3d> c) {
  const double part = t.size() == 2 ? 1.0 / 3 : 0.5;
  const double first_free = t[0] + part * (t[1] - t[0]);
  const double last_free = t.back() - part * (t.back() - t[t.size() - 2]);
  t.insert(t.begin() + 1, first_free);
  t.insert(t.end() - 1, last_free);
  c.insert(c.begin() + 1, c.front());
  c.insert(c.end() - 1, c.back());
  const std::vector<Vector3d> m = CalcSecondDerivatives(t, c);

  const std::size_t n = t.size() - 1;
  Vector3d v = Vector3d::Zero();
  for (std::size_t i = 0; i < n; ++i) {
    const double h = t[i + 1] - t[i];
    Vector3d x = c[i];
    if (i == 1) x += (t[1] - t[0]) * (t[1] - t[0]) / 6 * m[1];
    if (i == n - 1) x += h * h / 6 * m[i];
    knots_s_.push_back(t[i]);
    pieces_.push_back({x, v, m[i], (m[i + 1] - m[i]) / h});
    v += 0.5 * h * (m[i] + m[i + 1]);
  }
}

SplinePoint CubicSpline::Eval(double t_s) const {
  const auto after = std::upper_bound(knots_s_.begin(), knots_s_.end(), t_s);
  const std::size_t i =
      after == knots_s_.begin() ? 0 : static_cast<std::size_t>(after - knots_s_.begin()) - 1;
  const Piece& p = pieces_[i];
  const double T = t_s - knots_s_[i];
  return {p.x + T * (p.v + T * (p.a / 2 + T / 6 * p.j)), p.v + T * (p.a + T / 2 * p.j), p.a + T * p.j};
}

}  // namespace piperun::sim
