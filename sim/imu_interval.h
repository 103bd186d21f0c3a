#pragma once

#include "base/pose.h"
#include "sim/truth.h"

namespace piperun::sim {

/// What a perfect inertial sensor at a point fixed in the ball measures over an interval, in B.
struct ImuInterval {
  double duration_s = 0;
  Vector3d w_mean_rad_s;  ///< mean of w_WB_B
  Vector3d f_mean_m_s2;   ///< mean of the point's specific force
};

/// Means over (begin, end] at the point `p_BP` from the truth steps that cover the interval; a step of which
/// only a part lies inside counts with that part, so that adjoining intervals add up to the whole at any
/// rate.
///
/// Rate: w_mean = sum(dtheta) / T.
/// Specific force: the solver's value of the centre at step n belongs to [t_n - dt/2, t_n + dt/2], where it
/// is held constant *in W* and turned with the ball (gravity in a spinning ball is averaged exactly); the
/// lever adds w' x p_BP + w x (w x p_BP) with w = dtheta/dt and w' = (w_n - w_{n-1})/dt per step. Second
/// order in dt.
///
/// The window must hold the steps from the one at or before `begin` to the one at or after `end`.
ImuInterval CalcImuInterval(const TruthWindow& window, TrueTime begin, TrueTime end, const Vector3d& p_BP);

/// The same interval as one step of v += R dv + g T; R = R Exp(dtheta).
struct ImuIntervalIncrements {
  double duration_s = 0;
  Vector3d dtheta_rad;  ///< Log(R_begin^T R_end); shorter way round
  Vector3d dv_m_s;      ///< velocity gained beyond gravity, in the axes of B at the interval's begin
};

/// Step n adds dv_n = u_n - u_{n-1} - g dt, u_n the point's mean velocity over step n and u_0 its velocity at
/// the start, turned into the axes of the interval's begin. With p += v dt at the physics rate this returns
/// the trajectory of the point to rounding; at any rate it returns velocity and attitude. Absolute positions
/// never enter: their differences would cost 1e-8 m/s^2 at 100 m and 1 kHz.
ImuIntervalIncrements CalcImuIncrements(const TruthWindow& window, TrueTime begin, TrueTime end,
                                        const Vector3d& p_BP, const Vector3d& gravity_W);

/// Mean over (begin, end] of A = Skew(w') + Skew(w)^2 in B: a point fixed in the ball at p from the centre
/// has the acceleration A p beyond the centre's.
Matrix3d CalcMeanLeverTensor(const TruthWindow& window, TrueTime begin, TrueTime end);

/// What a perfect inertial sensor at a point fixed in the ball feels, in B.
struct ImuSignal {
  Vector3d w_rad_s;     ///< w_WB_B
  Vector3d f_m_s2;      ///< the point's specific force
  Matrix3d lever_1_s2;  ///< A of CalcMeanLeverTensor
};

/// Means over the physics step from a to b; second order in dt like CalcImuInterval.
ImuSignal CalcImuStep(const TruthState& a, const TruthState& b, const Vector3d& p_BP, double dt_s);

/// At an instant, by Interpolate; w' is that of the step around it.
ImuSignal CalcImuInstant(const TruthWindow& window, TrueTime t, const Vector3d& p_BP);

}  // namespace piperun::sim
