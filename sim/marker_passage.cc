#include "sim/marker_passage.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/check.h"

namespace piperun::sim {

PassageDetector::PassageDetector(double range_m) : range2_m2_(range_m * range_m) {
  Demand(range_m > 0, "a receiver hears some way");
}

std::optional<Passage> PassageDetector::Step(TrueTime t, double distance2_m2) {
  const Sample next{t, distance2_m2};
  TakeVertex(next);
  if (distance2_m2 > range2_m2_) {
    before_ = std::exchange(last_, next);
    return std::exchange(closest_, std::nullopt);
  }
  Take({t, std::sqrt(distance2_m2)});
  before_ = std::exchange(last_, next);
  return std::nullopt;
}

void PassageDetector::Jump() {
  before_.reset();
  last_.reset();
}

std::optional<Passage> PassageDetector::End() {
  Jump();
  return std::exchange(closest_, std::nullopt);
}

/// Of the parabola through the two latest steps and the next one, where the middle one is the lowest.
void PassageDetector::TakeVertex(const Sample& next) {
  if (!before_ || !closest_) return;
  const double d0 = before_->distance2_m2, d1 = last_->distance2_m2, d2 = next.distance2_m2;
  const double curvature = d0 - 2 * d1 + d2;
  if (d1 > d0 || d1 > d2 || curvature <= 0) return;
  const double steps = 0.5 * (d0 - d2) / curvature;
  const double lowest = d1 - 0.25 * (d0 - d2) * steps;
  Take({last_->time + FromSeconds(steps * Seconds(next.time - last_->time)),
        std::sqrt(std::max(0.0, lowest))});
}

void PassageDetector::Take(const Passage& passage) {
  if (!closest_ || passage.distance_m < closest_->distance_m) closest_ = passage;
}

}  // namespace piperun::sim
