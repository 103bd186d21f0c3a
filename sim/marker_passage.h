#pragma once

#include <optional>

#include "base/pose.h"
#include "base/time.h"

namespace piperun::sim {

/// When and how near something came to a receiver.
struct Passage {
  TrueTime time{};
  double distance_m = 0;
};

/// Tells the passages of one receiver from the distances of what moves by it, step by step.
///
/// A visit lasts while the distance d is at most the range. Its passage is the closest approach: the vertex
/// of the parabola through d^2 at three steps of dt,
///
///   t = t_1 + dt/2 (d_0^2 - d_2^2)/(d_0^2 - 2 d_1^2 + d_2^2),   d_1^2 <= d_0^2, d_2^2
///
/// exact for a straight way at constant speed, whose d^2 is a parabola. A visit that begins or ends the
/// record has its passage at the closest step.
class PassageDetector {
 public:
  /// `range_m` is positive.
  explicit PassageDetector(double range_m);

  /// The next step; steps are of one length until Jump() or End(). Returns the passage of the visit that
  /// ended with it.
  std::optional<Passage> Step(TrueTime t, double distance2_m2);
  /// The next step does not follow from the last one: there is no closest approach between them.
  void Jump();
  /// Nothing comes any more, or for a while that is far away: the passage of a visit that was going on.
  std::optional<Passage> End();

 private:
  struct Sample {
    TrueTime time{};
    double distance2_m2 = 0;
  };

  void TakeVertex(const Sample& next);
  void Take(const Passage& passage);

  double range2_m2_;
  std::optional<Sample> before_, last_;  // the two latest steps
  std::optional<Passage> closest_;       // of the present visit
};

}  // namespace piperun::sim
