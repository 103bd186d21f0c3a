#pragma once

#include <array>
#include <string_view>

#include "sim/drag.h"

namespace piperun::sim {

/// Wall factors f = V_t(tube) / V_t(free): how much slower a sphere settles on the axis of a tube, l = d/D,
/// Re the Reynolds number at which the *free* sphere settles:
///
///   kehlenbeck_di_felice  (1 - l^p) / (1 + (l/l0)^p),   (l0 - 0.283)/(1.2 - l0) = 0.041 Re^0.524,
///                         p = 1.44 + 0.5466 Re^0.434 (Re <= 35),   2.3 + 37.3 Re^-0.8686 (Re > 35)
///   di_felice             ((1 - l) / (1 - 0.33 l))^a,   (3.3 - a)/(a - 0.85) = 0.1 Re
///   munroe                1 - l^1.5                                                       high Re
///   newton                (1 - l^2) sqrt(1 - l^2/2)                                       high Re
///   none                  1
///
/// Kehlenbeck & Di Felice, Chem. Eng. Technol. 22, 303 (1999); Di Felice, Int. J. Multiphase Flow 22, 527
/// (1996); Munroe, Trans. AIME 17, 637 (1888); Newton, Principia (1687), all constants from memory. Checked:
/// the first equals Newton's within 1.5 % for l <= 0.6 at high Re, and gives 0.788 at l = 0.1 in Stokes flow
/// against Haberman & Sayre's 0.792. The branches of p are joined where they cross, at Re = 35.04. Range:
/// 0 < l < 1 (data up to 0.9), Re >= 0; in Stokes flow above l = 0.5 the first is too large.
enum class WallFactorLaw { kKehlenbeckDiFelice, kDiFelice, kMunroe, kNewton, kNone };

struct WallFactorLawInfo {
  WallFactorLaw law;
  std::string_view key;
  std::string_view name;
  double max_diameter_ratio;  ///< of the data
};

const WallFactorLawInfo& FindWallFactorLaw(WallFactorLaw law);
/// By its key; aborts on a key that ForceParams does not offer.
const WallFactorLawInfo& FindWallFactorLaw(std::string_view key);

double CalcWallFactor(WallFactorLaw law, double diameter_ratio, const Reynolds& free_reynolds);

/// ln f for a sphere that moves at its own Re in the tube: the f for which f = CalcWallFactor(l, Re/f).
///
/// f is defined by settling speeds, so that the drag in the tube at u_rel is the free sphere's at u_rel / f,
/// for every Re: a factor 1/f in Stokes flow, 1/f^2 at high Re. Solved to rounding by secants.
double SolveLogWallFactor(WallFactorLaw law, double diameter_ratio, const Reynolds& reynolds);

/// The same for one d/D, from a table: cubics in ln Re for 40 < Re < 1e7, relative error of f below 1e-6
/// for d/D <= 0.95; solved where the table ends.
class WallFactorTable {
 public:
  WallFactorTable(WallFactorLaw law, double diameter_ratio);
  double EvalLog(const Reynolds& reynolds) const;
  double diameter_ratio() const { return diameter_ratio_; }

 private:
  static constexpr int kNodes = 513;

  WallFactorLaw law_;
  double diameter_ratio_;
  std::array<double, kNodes> log_f_{};
};

}  // namespace piperun::sim
