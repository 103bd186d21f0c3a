#pragma once

#include "base/pose.h"
#include "sim/truth.h"

namespace piperun::sim {

/// What a perfect inertial sensor at a point fixed in the ball measures over an interval, in B.
struct ImuInterval {
  double duration_s = 0;
  Vector3d w_mean_rad_s;  ///< mean of w_WB_B
  Vector3d f_mean_m_s2;   ///< mean of the point's specific force
  Vector3d dv_m_s;        ///< sum of the point's leapfrog velocity increments
};

/// Means over (begin, end] at the point `p_BP` from the truth steps that cover the interval; a step of which
/// only a part lies inside counts with that part, so that adjoining intervals add up to the whole at any
/// rate.
///
/// Rate: w_mean = sum(dtheta) / T.
/// Specific force: the solver's value of the centre at step n belongs to [t_n - dt/2, t_n + dt/2], where it
/// is held constant *in W* and turned with the ball (gravity in a spinning ball is averaged exactly); the
/// lever adds w' x p_BP + w x (w x p_BP) with w = dtheta/dt and w' = (w_n - w_{n-1})/dt per step. Second
/// order in dt. Increments: dv_n = R_{n-1}^T (u_n - u_{n-1} - g dt), u_n the point's mean velocity over step
/// n and u_0 its velocity at the start. At the physics rate v += R dv + g dt; p += v dt; R = R Exp(dtheta)
/// returns the trajectory of the point to rounding. Absolute positions never enter: their differences would
/// cost 1e-8 m/s^2 at 100 m and 1 kHz.
///
/// The window must hold the steps from the one at or before `begin` to the one at or after `end`.
ImuInterval CalcImuInterval(const TruthWindow& window, TrueTime begin, TrueTime end, const Vector3d& p_BP,
                            const Vector3d& gravity_W);

}  // namespace piperun::sim
