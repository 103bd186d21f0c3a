#pragma once

#include <string>
#include <vector>

#include "base/route.h"

namespace piperun::sim {

/// A bend as the water that goes through it meets it.
struct BendShape {
  double turn_rad = 0;
  double radius_ratio = 0;  ///< R/r: radius of the axis over that of the bore, > 1
};

/// Loss coefficient of a bend in a smooth pipe, h = K U^2/(2 g): all the head that bend and disturbed flow
/// behind it cost, less what a straight pipe as long would cost behind it. Ito, J. Basic Eng. 82, 131 (1960);
/// with x = Re (r/R)^2 and theta in degrees
///
///   x > 91   K = 0.00241 alpha theta Re^-0.17 (R/r)^0.84
///   x < 91   K = 0.00873 alpha f_c theta R/r,   f_c sqrt(R/r) = 0.029 + 0.304 x^-1/4 (straight for x <
///   0.034)
///
///   alpha  45:   1 + 14.2 (R/r)^-1.47
///          90:   0.95 + 17.2 (R/r)^-1.96, 1 above R/r = 19.7
///          180:  1 + 116 (R/r)^-4.52
///
/// f_c: Ito, J. Basic Eng. 81, 123 (1959). Between its three angles alpha is linear in theta, outside it
/// stays (our choice). Measured for 2e4 < Re < 4e5 and R/r >= 2; other values are extrapolated. Below Re =
/// 2300 the loss is linear in the speed (our choice; Ito's are turbulent). The two branches meet within 1 %.
/// Range: Re > 0, R/r > 1, theta > 0 (aborts outside).
double CalcBendLoss(const BendShape& bend, double reynolds);

/// The part of it that is not friction of a straight smooth pipe (Blasius: f = 0.3164 Re^-1/4, the limit of
/// Ito's f_c) of the bend's own length: what a bend costs on top of the friction along its axis. Never
/// negative.
double CalcExcessBendLoss(const BendShape& bend, double reynolds);

/// The part of a bend that lies in one leg of a route.
struct BendPart {
  double begin_m = 0;  ///< along the leg, in the direction of travel
  double end_m = 0;
  double radius_m = 0;  ///< of the axis
  double turn_rad = 0;  ///< of the whole bend: it may have begun in the leg before, or go on in the next
  double share = 1;     ///< of the whole bend
};

/// The bends of a route, leg by leg. Arcs of the same radius that go on in the same plane are one bend.
std::vector<std::vector<BendPart>> FindBends(const Network& network, const Route& route);

/// How far beyond the range of Ito's measurements his law was used.
class BendLossRange {
 public:
  void Add(const BendShape& bend, double reynolds);
  /// A sentence for each side that was left; empty when all was within.
  std::vector<std::string> Warnings() const;

 private:
  double least_reynolds_ = 0, greatest_reynolds_ = 0, least_ratio_ = 0;
  bool used_ = false;
};

}  // namespace piperun::sim
