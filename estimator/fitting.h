#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/network.h"
#include "base/route.h"

namespace piperun::estimator {

/// What else than a leak makes a noise at a place that the map knows.
enum class FittingKind { kPump, kValve, kService, kTee };

/// "pump", "valve", "service", "tee".
const char* Name(FittingKind kind);

/// A fitting where the map shows it.
struct Fitting {
  FittingKind kind = FittingKind::kValve;
  std::string id;
  int pipe = 0;  ///< of the map's network
  double s_m = 0;

  std::string Label() const { return std::string(Name(kind)) + " " + id; }
};

/// Chances that a fitting of a kind is heard as a leak would be, because it hums, throttles or draws water,
/// and that it leaks itself at a gland or flange. Engineering values; nothing is published.
struct FittingPrior {
  double noisy = 0;
  double leaking = 0;
};
FittingPrior CalcFittingPrior(FittingKind kind);

/// A fitting on the way of a ball or beside it.
struct PlacedFitting {
  std::string label;
  FittingPrior prior;
  double chainage_m = 0;
};

/// Those of the map, and the tees of the route (nodes where three pipes or more meet), in order of chainage.
/// One beside the route counts where its branch leaves it, up to 5 m of branch.
std::vector<PlacedFitting> PlaceFittings(const Network& network, const Route& route,
                                         const std::vector<Fitting>& fittings);

/// How well drawings place a fitting, standard deviation; its own length included.
constexpr double kFittingPlace_sd_m = 1;

/// What a place of a sound means, given the fittings about it.
struct FittingVerdict {
  std::optional<std::string> at;  ///< the likeliest noisy fitting within 1.96 standard deviations
  double confidence = 0;          ///< that it is a leak
};

/// Bayes' theorem over four origins of a sound that was told at x with standard deviation s, d_i the distance
/// to fitting i, N the normal density of standard deviation (s^2 + (1 m)^2)^(1/2), lambda = 1 per km of leaks
/// anywhere, f = lambda (1 - c) / c the density of false alarms behind the locator's own confidence c:
///
///     P(leak) = (lambda + sum L_i N(d_i)) / (lambda + f + sum (L_i + V_i) N(d_i))
///
/// with the chances V_i that fitting i is noisy and L_i that it leaks. Without fittings it is c. It never
/// falls to zero: a leak beside a valve stays in the list, at lower odds. Range: 0 < c <= 1, s >= 0.
FittingVerdict JudgeByFittings(const std::vector<PlacedFitting>& fittings, double chainage_m, double sigma_m,
                               double confidence);

}  // namespace piperun::estimator
