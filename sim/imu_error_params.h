#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "base/params.h"
#include "base/pose.h"
#include "sim/imu_filter.h"

namespace piperun::sim {

/// Names of the fields whose unit differs between gyroscope (u = rad/s) and accelerometer (u = m/s^2).
struct TriadFieldNames {
  std::string_view bias;
  std::string_view bias_sd;
  std::string_view noise;
  std::string_view bias_instability;
  std::string_view rate_random_walk;
  std::string_view range;
  std::string_view resolution;
  std::string_view scale_second_order;
  std::string_view temperature_bias;
  std::string_view g_sensitivity;  ///< empty: the triad has none
  std::string_view vibration_rectification;
  std::string_view gauss_markov_sd;
  std::string_view rate_ramp;
  std::string_view quantisation;
};
extern const TriadFieldNames kGyroFields;
extern const TriadFieldNames kAccelFields;

/// Errors of three orthogonal inertial axes, in the triad's own unit u. The defaults are those of an ideal
/// sensor. In the sensor frame S, with x the true input, f the true specific force there, one row per axis
/// and T - T0 the temperature above the reference,
///
///   y = Q{ clip{ F[ (I + diag(s + s_T (T - T0) + s_i(t)) + M) x + s2 |x| x + a/2 |x| + v f^2 + G f + n ]
///                + b0 + c_T (T - T0) + b_GM + b_B + b_K + R t } }
///
/// s: scale-factor error, fixed + sd per run; s_T: its change with temperature; s_i: scale-factor
/// instability, a Gauss-Markov process; M: misalignment, M_ij (i != j) the part of x_j that axis i sees, to
/// first order an angle in rad (a common rotation is the antisymmetric part), diagonal added to s,
/// off-diagonals fixed + sd per run; s2: second order, relative change of the scale per u; a: asymmetry,
/// scale for positive less scale for negative input; v: vibration rectification, f^2 the square of the axis's
/// own specific force (of the whole one, |f|^2, for a gyroscope) at the physics rate; G: g-sensitivity of a
/// gyroscope; n: white noise of density N; F: the filters; b0: bias, fixed + drawn at turn-on; c_T: its
/// change with temperature; b_GM: Gauss-Markov process; b_B: bias instability (imu_error.h); b_K: random walk
/// of the bias, step K sqrt(dt); R: ramp; Q: the register. Terms and symbols: IEEE Std 952-1997, annex C, and
/// IEEE Std 1293.
struct TriadErrorParams {
  Vector3d bias = Vector3d::Zero();          ///< u
  double bias_sd = 0;                        ///< u, per axis and run
  Vector3d scale_error = Vector3d::Zero();   ///< dimensionless
  double scale_error_sd = 0;                 ///< dimensionless, per axis and run
  Matrix3d misalignment = Matrix3d::Zero();  ///< M, dimensionless
  double noise = 0;                          ///< N, u / sqrt(Hz)
  double bias_instability = 0;               ///< B, u
  double rate_random_walk = 0;               ///< K, u / s / sqrt(Hz)
  std::optional<double> range;               ///< u, clips at +-range
  double resolution = 0;                     ///< u per count of the output register

  Vector3d scale_second_order = Vector3d::Zero();       ///< s2, 1/u
  Vector3d scale_asymmetry = Vector3d::Zero();          ///< a, dimensionless
  double scale_instability = 0;                         ///< sd of s_i, dimensionless
  double scale_instability_time_s = 1000;               ///< its correlation time
  double misalignment_sd = 0;                           ///< per off-diagonal element and run, dimensionless
  Vector3d temperature_bias = Vector3d::Zero();         ///< c_T, u/K
  Vector3d temperature_scale = Vector3d::Zero();        ///< s_T, 1/K
  Matrix3d g_sensitivity = Matrix3d::Zero();            ///< G, u/(m/s^2)
  Vector3d vibration_rectification = Vector3d::Zero();  ///< v, u/(m/s^2)^2
  double gauss_markov_sd = 0;                           ///< sigma of b_GM, u
  double gauss_markov_time_s = 100;                     ///< its correlation time T
  Vector3d rate_ramp = Vector3d::Zero();                ///< R, u/s
  double quantisation = 0;                              ///< Q of IEEE 952, u s
  ImuFilterParams filter;
  std::string stuck_axis = "none";
  double stuck_from_s = 0;

  void Visit(ParamVisitor& v, const TriadFieldNames& names);

 private:
  void VisitScale(ParamVisitor& v, const TriadFieldNames& names);
  void VisitOutside(ParamVisitor& v, const TriadFieldNames& names);
  void VisitDrift(ParamVisitor& v, const TriadFieldNames& names);
  void VisitOutput(ParamVisitor& v, const TriadFieldNames& names);
};

}  // namespace piperun::sim
