#include "sim/bend_loss.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/check.h"
#include "sim/figure.h"

namespace piperun::sim {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kLaminarReynolds = 2300;
constexpr double kLeastReynolds = 2e4, kGreatestReynolds = 4e5, kLeastRatio = 2;  // of the measurements

double CalcInverseFourthRoot(double x) { return 1 / std::sqrt(std::sqrt(x)); }

double CalcBlasiusFriction(double reynolds) { return 0.3164 * CalcInverseFourthRoot(reynolds); }

/// Ito's alpha at 45, 90 and 180 degrees, linear between.
double CalcAlpha(double turn_deg, double ratio) {
  const double at_45 = 1 + 14.2 * std::pow(ratio, -1.47);
  const double at_90 = ratio > 19.7 ? 1 : 0.95 + 17.2 * std::pow(ratio, -1.96);
  if (turn_deg <= 90) return std::lerp(at_45, at_90, std::max(turn_deg - 45, 0.0) / 45);
  const double at_180 = 1 + 116 * std::pow(ratio, -4.52);
  return std::lerp(at_90, at_180, std::min(turn_deg - 90, 90.0) / 90);
}

/// Darcy friction factor of a long bend.
double CalcCurvedFriction(double reynolds, double ratio) {
  const double x = reynolds / (ratio * ratio);
  if (x < 0.034) return CalcBlasiusFriction(reynolds);
  return (0.029 + 0.304 * CalcInverseFourthRoot(x)) / std::sqrt(ratio);
}

double CalcTurbulentBendLoss(const BendShape& bend, double reynolds) {
  const double turn_deg = bend.turn_rad / kDegree, ratio = bend.radius_ratio;
  const double alpha = CalcAlpha(turn_deg, ratio);
  if (reynolds / (ratio * ratio) > 91)
    return 0.00241 * alpha * turn_deg * std::pow(reynolds, -0.17) * std::pow(ratio, 0.84);
  return 0.5 * kDegree * alpha * CalcCurvedFriction(reynolds, ratio) * turn_deg * ratio;
}

void DemandRange(const BendShape& bend, double reynolds) {
  Demand(reynolds > 0 && bend.radius_ratio > 1 && bend.turn_rad > 0, "a bend turns flowing water");
}

/// A loss that is linear in the speed below the turbulent range.
template <class Law>
double WithLaminarRange(Law law, double reynolds) {
  if (reynolds >= kLaminarReynolds) return law(reynolds);
  return law(kLaminarReynolds) * kLaminarReynolds / reynolds;
}

/// The pieces of a leg in the direction of travel; their s begins at its beginning.
std::vector<CentrelinePiece> WalkLeg(const Pipe& pipe, bool reversed) {
  std::vector<CentrelinePiece> pieces = pipe.centreline;
  if (!reversed) return pieces;
  std::reverse(pieces.begin(), pieces.end());
  double along_m = 0;
  for (CentrelinePiece& piece : pieces) {
    piece = Reversed(piece, along_m);
    along_m += piece.length_m;
  }
  return pieces;
}

/// Whether an arc goes on where another ends: the same radius, and its centre on the same side.
bool GoesOn(const CentrelinePiece& before, const CentrelinePiece& after) {
  constexpr double kClose = 1e-6;
  if (before.straight() || after.straight()) return false;
  const double ratio = after.curvature_1_m / before.curvature_1_m;
  const Vector3d normal = EvalCentreline(before, before.s_end_m()).curvature_W / before.curvature_1_m;
  return std::abs(ratio - 1) < kClose && normal.dot(after.normal_begin_W) > 1 - kClose;
}

}  // namespace

double CalcBendLoss(const BendShape& bend, double reynolds) {
  DemandRange(bend, reynolds);
  return WithLaminarRange([&](double re) { return CalcTurbulentBendLoss(bend, re); }, reynolds);
}

double CalcExcessBendLoss(const BendShape& bend, double reynolds) {
  DemandRange(bend, reynolds);
  const auto excess = [&](double re) {
    return CalcTurbulentBendLoss(bend, re) -
           0.5 * CalcBlasiusFriction(re) * bend.turn_rad * bend.radius_ratio;
  };
  return WithLaminarRange(excess, reynolds);
}

std::vector<std::vector<BendPart>> FindBends(const Network& network, const Route& route) {
  std::vector<std::vector<BendPart>> legs(route.legs().size());
  std::vector<BendPart*> bend;  // the parts of the present one
  CentrelinePiece before;
  const auto finish = [&] {
    double turn_rad = 0;
    for (const BendPart* part : bend) turn_rad += part->turn_rad;
    for (BendPart* part : bend) {
      part->share = part->turn_rad / turn_rad;
      part->turn_rad = turn_rad;
    }
    bend.clear();
  };
  for (std::size_t leg = 0; leg < legs.size(); ++leg) {
    const auto pieces = WalkLeg(network.pipe(route.legs()[leg].pipe), route.legs()[leg].reversed);
    legs[leg].reserve(pieces.size());
    for (const CentrelinePiece& piece : pieces) {
      if (!GoesOn(before, piece)) finish();
      before = piece;
      if (piece.straight()) continue;
      legs[leg].push_back(
          {piece.s_begin_m, piece.s_end_m(), 1 / piece.curvature_1_m, piece.length_m * piece.curvature_1_m});
      bend.push_back(&legs[leg].back());
    }
  }
  finish();
  return legs;
}

void BendLossRange::Add(const BendShape& bend, double reynolds) {
  least_reynolds_ = used_ ? std::min(least_reynolds_, reynolds) : reynolds;
  greatest_reynolds_ = used_ ? std::max(greatest_reynolds_, reynolds) : reynolds;
  least_ratio_ = used_ ? std::min(least_ratio_, bend.radius_ratio) : bend.radius_ratio;
  used_ = true;
}

std::vector<std::string> BendLossRange::Warnings() const {
  std::vector<std::string> warnings;
  const auto warn = [&](const std::string& what, double value, const std::string& range) {
    warnings.push_back("bend losses (Ito 1960) are extrapolated to " + what + " = " + FormatFigure(value) +
                       "; they were measured for " + range);
  };
  if (!used_) return warnings;
  if (least_reynolds_ < kLeastReynolds) warn("Re", least_reynolds_, "2e4 < Re < 4e5");
  if (greatest_reynolds_ > kGreatestReynolds) warn("Re", greatest_reynolds_, "2e4 < Re < 4e5");
  if (least_ratio_ < kLeastRatio) warn("R/r", least_ratio_, "R/r >= 2 (bend over bore radius)");
  return warnings;
}

}  // namespace piperun::sim
