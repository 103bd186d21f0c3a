#pragma once

namespace piperun::sim {

/// Swirl switching: the single cell behind a bend (sim/secondary_flow.h) turns with B U s(t) times its
/// strength, and s changes its sense at random around a low frequency:
///
///   ds = w0 y dt,   dy = (-w0 s - gamma y) dt + sqrt(2 gamma) dW,   w0 = 2 pi St U/D,   gamma = w0/2
///
/// a narrow band of unit variance about St = 0.2. Hellstrom, Zlatinov, Cao & Smits, J. Fluid Mech. 735
/// (2013), R7, found the switching cell to be the most energetic structure behind a 90 degree bend at Re 2e4
/// to 1.15e5, as strong as the cells of the pair. Reported St: 0.1 to 0.5 (from memory). B = 0.1 and the
/// bandwidth are choices.
inline constexpr double kSwirlStrouhal = 0.2;
inline constexpr double kSwirlSpeed = 0.1;    ///< B
inline constexpr double kSwirlDamping = 0.5;  ///< gamma / w0

/// The swirl that switches at an instant.
struct Swirl {
  double s = 0;
  double ds_dt_1_s = 0;
};

}  // namespace piperun::sim
