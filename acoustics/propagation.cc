#include "acoustics/propagation.h"

#include <algorithm>
#include <limits>

#include "base/check.h"

namespace piperun::acoustics {

std::size_t FindLeg(const std::vector<AcousticLeg>& legs, double chainage_m) {
  Demand(!legs.empty(), "an acoustic scene has at least one leg");
  const auto after =
      std::upper_bound(legs.begin() + 1, legs.end(), chainage_m,
                       [](double s, const AcousticLeg& leg) { return s < leg.chainage_begin_m; });
  return static_cast<std::size_t>(after - legs.begin()) - 1;
}

double CalcPathInLeg(const std::vector<AcousticLeg>& legs, std::size_t i, double from_m, double to_m) {
  constexpr double kBeyond = std::numeric_limits<double>::infinity();
  const double begin = i == 0 ? -kBeyond : legs[i].chainage_begin_m;
  const double end = i + 1 == legs.size() ? kBeyond : legs[i + 1].chainage_begin_m;
  const auto [near, far] = std::minmax(from_m, to_m);
  return std::max(0.0, std::min(far, end) - std::max(near, begin));
}

double CalcPathLoss_Np(const std::vector<AcousticLeg>& legs, double from_m, double to_m, double f_Hz) {
  double loss = 0;
  for (std::size_t i = 0; i < legs.size(); ++i) {
    const double path_m = CalcPathInLeg(legs, i, from_m, to_m);
    if (path_m > 0) loss += path_m * legs[i].wave.Attenuation_Np_m(f_Hz);
  }
  return loss;
}

}  // namespace piperun::acoustics
