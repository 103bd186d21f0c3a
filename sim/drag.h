#pragma once

namespace piperun::sim {

/// Drag coefficient of a free sphere times its Reynolds number, C_D Re, which is finite at rest:
///
///   C_D = 24/Re (1 + 0.150 Re^0.681) + 0.407 / (1 + 8710/Re),   Re = |u_rel| d / nu
///
/// Brown & Lawler, J. Environ. Eng. 129, 222 (2003), fitted for Re < 2e5; the constants are from memory and
/// agree with the Clift-Gauvin refit within 0.6 % for 10 < Re < 2e5. Above, the formula stays near 0.41-0.46
/// and goes without the drag crisis, which a foam or rough cover suppresses (Achenbach, J. Fluid Mech. 65,
/// 113 (1974)). Any Re >= 0 is accepted; C_D Re -> 24 at rest (Stokes).
double CalcDragTimesReynolds(double reynolds);

/// C_D itself. Range: Re > 0.
double CalcDragCoefficient(double reynolds);

/// Wall factor f = V_t(tube) / V_t(free): how much slower a sphere settles on the axis of a tube,
///
///   f = (1 - l^p) / (1 + (l/l0)^p),   l = d/D,   (l0 - 0.283)/(1.2 - l0) = 0.041 Re^0.524,
///   p = 1.44 + 0.5466 Re^0.434 (Re <= 35),   2.3 + 37.3 Re^-0.8686 (Re > 35).
///
/// Kehlenbeck & Di Felice, Chem. Eng. Technol. 22, 303 (1999), from memory. Checked: Re -> infinity equals
/// Newton's wall factor within 1.5 %, Re -> 0 at l = 0.1 gives 0.788 against Haberman & Sayre's 0.792. Re is
/// taken as the sphere's own d |u_rel| / nu; with the free sphere's Re instead, f changes only for 0.1 < Re <
/// 1e3. Range: 0 < l < 1 (data up to 0.9), Re >= 0.
///
/// The definition of f makes the drag in the tube the free sphere's drag at the speed u_rel / f, for every
/// Re: a factor 1/f in Stokes flow, 1/f^2 at high Re.
double CalcWallFactor(double diameter_ratio, double reynolds);

/// Torque coefficient of a spinning sphere times its spin Reynolds number, C_w Re_w, finite at rest:
///
///   T = 1/2 rho r^5 C_w |w| w,   Re_w = d^2 |w| / nu (on the diameter),
///   C_w Re_w = 64 pi (Re_w <= 32, Stokes: T = 8 pi mu r^3 w),   12.9 sqrt(Re_w) + 128.4 above.
///
/// Dennis, Singh & Ingham, J. Fluid Mech. 101, 257 (1980), fitted for 20 < Re_w < 4e3; the two branches meet
/// within 0.2 %, and with Re_w on the diameter the high end is the boundary layer law 6.45 / sqrt(r^2 w / nu)
/// of Sawatzki, Acta Mech. 9, 159 (1970), used to Re_w ~ 2e5. Turbulent above, where it is too small.
double CalcSpinTorqueTimesReynolds(double spin_reynolds);

}  // namespace piperun::sim
