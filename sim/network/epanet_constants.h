#pragma once

/// The constants of the EPANET engine (2.2 and 2.3), turned into SI. EPANET computes in feet and cubic feet
/// per second with rounded constants; using the same ones makes heads and flows comparable to the last digits
/// and iteration counts equal. Source: Rossman et al., "EPANET 2.2 User Manual", EPA/600/R-20/133 (2020),
/// chapter 12 and appendix A; OWA-EPANET 2.3. Symbols: h head loss [m], q flow [m3/s], L length [m], d bore
/// [m].
namespace piperun::sim::epanet {

inline constexpr double kFoot_m = 0.3048;
inline constexpr double kSquareFoot_m2 = kFoot_m * kFoot_m;
inline constexpr double kCubicFoot_m3 = kFoot_m * kFoot_m * kFoot_m;
inline constexpr double kHorsepower_W = 745.7;

/// Gravity behind the Darcy-Weisbach law: 32.2 ft/s2, 0.08 % above the standard 9.80665 m/s2.
inline constexpr double kGravity_m_s2 = 32.2 * kFoot_m;
/// Kinematic viscosity of water at 20 C: 1.1e-5 ft2/s.
inline constexpr double kViscosity_m2_s = 1.1e-5 * kSquareFoot_m2;

/// h = kHazenWilliams L q^1.852 / (C^1.852 d^4.871); 4.727 ft^-0.685, ft^0.685 written out.
inline constexpr double kFootTo0685 = 0.44314948550603916;
inline constexpr double kHazenWilliams = 4.727 / kFootTo0685;
inline constexpr double kHazenWilliamsFlowExponent = 1.852;
inline constexpr double kHazenWilliamsBoreExponent = 4.871;
/// h = (4 n / (kManning pi d^2))^2 (d/4)^-1.333 L q^2; 1.49 ft^(1/3), the exponent rounded as EPANET rounds
/// it.
inline constexpr double kFootTo0667 = 0.45272865135800844;
inline constexpr double kManningSquared = 1.49 * 1.49 * kFootTo0667;
inline constexpr double kManningRadiusExponent = 1.333;
/// h = kMinorLoss K q^2 / d^4, 0.02517 s2/ft = 8 / (pi^2 g).
inline constexpr double kMinorLoss_s2_m = 0.02517 / kFoot_m;
/// h = kPumpPower P / q, 8.814 ft^4/(hp s) = 1 / (rho g).
inline constexpr double kPumpPower_m4_J = 8.814 * kSquareFoot_m2 * kSquareFoot_m2 / kHorsepower_W;
/// Orifice of [LEAKAGE]: q = kOrifice A sqrt(h), 0.6 sqrt(2 g) = 4.8149866 ft^0.5/s.
inline constexpr double kSquareRootOfFoot = 0.5520869496736904;
inline constexpr double kOrifice_m05_s = 4.8149866 * kSquareRootOfFoot;

/// Slope dh/dq [s/m2] of what is closed, of what is open and loses nothing, and of a barrier.
inline constexpr double kClosedSlope_s_m2 = 1e8 / kSquareFoot_m2;
inline constexpr double kOpenSlope_s_m2 = 1e-6 / kSquareFoot_m2;
inline constexpr double kBarrierSlope_s_m2 = 1e9 / kSquareFoot_m2;
inline constexpr double kBarrierRounding_m = 1e-3 * kFoot_m;
/// Weight that pins a head to a valve's setting [m2/s].
inline constexpr double kPinWeight_m2_s = 1e8 * kSquareFoot_m2;

inline constexpr double kFirstSpeed_m_s = kFoot_m;  ///< first guess of the speed in a pipe
inline constexpr double kFirstEmitterFlow_m3_s = kCubicFoot_m3;
inline constexpr double kFirstLeakageFlow_m3_s = 1e-3 * kCubicFoot_m3;
inline constexpr double kFirstPowerPumpFlow_m3_s = kCubicFoot_m3;
inline constexpr double kZeroFlow_m3_s = 1e-6 * kCubicFoot_m3;
/// How near the flow of a leak, or a demand under pressure, must come to its own law.
inline constexpr double kOutflowTolerance_m3_s = 1e-4 * kCubicFoot_m3;
inline constexpr double kOutflowRelativeTolerance = 1e-3;

}  // namespace piperun::sim::epanet
