#include "estimator/fitting.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

#include "base/check.h"

namespace piperun::estimator {
namespace {

constexpr double kLeaks_per_m = 1e-3;
constexpr double kLongestBranch_m = 5;
constexpr double kQuantile975 = 1.959963984540054;

/// Chainage of every node of the route; a node passed twice counts once.
std::vector<std::pair<int, double>> PlaceNodes(const Network& network, const Route& route) {
  std::vector<std::pair<int, double>> nodes;
  double chainage_m = 0;
  for (const RouteLeg& leg : route.legs()) {
    const Pipe& pipe = network.pipe(leg.pipe);
    if (nodes.empty()) nodes.emplace_back(leg.reversed ? pipe.to : pipe.from, 0.0);
    chainage_m += pipe.length_m;
    nodes.emplace_back(leg.reversed ? pipe.from : pipe.to, chainage_m);
  }
  return nodes;
}

/// Where a fitting is heard on the route: at its place, or at the node where its branch leaves.
std::optional<double> FindChainage_m(const Network& network, const Route& route, const Fitting& fitting) {
  if (const auto on_route_m = route.Chainage(fitting.pipe, fitting.s_m)) return on_route_m;
  const Pipe& pipe = network.pipe(fitting.pipe);
  if (fitting.s_m > pipe.length_m) return std::nullopt;  // beyond what the map holds of it
  for (const auto& [node, chainage_m] : PlaceNodes(network, route)) {
    if (node == pipe.from && fitting.s_m <= kLongestBranch_m) return chainage_m;
    if (node == pipe.to && pipe.length_m - fitting.s_m <= kLongestBranch_m) return chainage_m;
  }
  return std::nullopt;
}

double CalcNormalDensity_1_m(double distance_m, double sd_m) {
  const double u = distance_m / sd_m;
  return std::exp(-0.5 * u * u) / (sd_m * std::sqrt(2 * std::numbers::pi));
}

}  // namespace

const char* Name(FittingKind kind) {
  switch (kind) {
    case FittingKind::kPump:
      return "pump";
    case FittingKind::kValve:
      return "valve";
    case FittingKind::kService:
      return "service";
    case FittingKind::kTee:
      break;
  }
  return "tee";
}

FittingPrior CalcFittingPrior(FittingKind kind) {
  switch (kind) {
    case FittingKind::kPump:
      return {0.9, 0.05};
    case FittingKind::kValve:
      return {0.3, 0.05};
    case FittingKind::kService:
      return {0.1, 0.05};
    case FittingKind::kTee:
      break;
  }
  return {0.02, 0.01};
}

std::vector<PlacedFitting> PlaceFittings(const Network& network, const Route& route,
                                         const std::vector<Fitting>& fittings) {
  std::vector<PlacedFitting> placed;
  for (const Fitting& fitting : fittings) {
    if (const auto chainage_m = FindChainage_m(network, route, fitting))
      placed.push_back({fitting.Label(), CalcFittingPrior(fitting.kind), *chainage_m});
  }
  for (const auto& [node, chainage_m] : PlaceNodes(network, route)) {
    if (network.EndsAt(node).size() < 3) continue;
    const std::string& id = network.nodes()[static_cast<std::size_t>(node)].id;
    placed.push_back({"tee " + id, CalcFittingPrior(FittingKind::kTee), chainage_m});
  }
  std::sort(placed.begin(), placed.end(), [](const auto& a, const auto& b) {
    return std::tie(a.chainage_m, a.label) < std::tie(b.chainage_m, b.label);
  });
  return placed;
}

FittingVerdict JudgeByFittings(const std::vector<PlacedFitting>& fittings, double chainage_m, double sigma_m,
                               double confidence) {
  Demand(confidence > 0 && confidence <= 1, "a locator's confidence is a probability");
  const double sd_m = std::hypot(sigma_m, kFittingPlace_sd_m);
  double leaks_1_m = kLeaks_per_m, others_1_m = kLeaks_per_m * (1 - confidence) / confidence;
  double likeliest_1_m = 0;
  FittingVerdict verdict;
  for (const PlacedFitting& fitting : fittings) {
    const double distance_m = std::abs(fitting.chainage_m - chainage_m);
    const double density_1_m = CalcNormalDensity_1_m(distance_m, sd_m);
    leaks_1_m += fitting.prior.leaking * density_1_m;
    others_1_m += fitting.prior.noisy * density_1_m;
    if (distance_m > kQuantile975 * sd_m || fitting.prior.noisy * density_1_m <= likeliest_1_m) continue;
    likeliest_1_m = fitting.prior.noisy * density_1_m;
    verdict.at = fitting.label;
  }
  verdict.confidence = leaks_1_m / (leaks_1_m + others_1_m);
  return verdict;
}

}  // namespace piperun::estimator
