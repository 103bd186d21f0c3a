#include "sim/cross_flow.h"

namespace piperun::sim {
namespace {

constexpr double kOnAxis_m = 1e-12;  // closer, the direction away from the axis means nothing

/// The flow across the pipe at one place, ready to be differentiated along any direction.
struct CrossField {
  const CrossPlace& place;
  const CrossSpeed& speed;
  double stretch, p, g;
  Vector3d round;  // d x t
  Vector3d bracket;

  CrossField(const CrossPlace& at, const CrossSpeed& with)
      : place(at),
        speed(with),
        stretch(1 / (1 - at.offset_W.dot(at.curvature_W))),
        p(1 - Reach2() / Radius2()),
        g(at.offset_W.dot(at.axis_W.cross(with.cells_W_m_s))),
        round(at.offset_W.cross(at.axis_W)),
        bracket(p * with.cells_W_m_s - (2 / Radius2() * g + with.swirl_m_s / at.radius_m * p) * round) {}

  double Radius2() const { return place.radius_m * place.radius_m; }
  double Reach2() const { return place.ball_radius_m * place.ball_radius_m + place.offset_W.squaredNorm(); }
  Vector3d CalcDerivative(const Vector3d& along) const;
};

/// (along . grad) u by the chain rule over s, t, d, w, c and R.
Vector3d CrossField::CalcDerivative(const Vector3d& along) const {
  const Vector3d &t = place.axis_W, &d = place.offset_W, &w = speed.cells_W_m_s;
  const double ds = stretch * t.dot(along), radius = place.radius_m;
  const Vector3d dt = ds * place.curvature_W, dd = along - ds * t, dw = ds * speed.cells_slope_W_1_s;
  const double dradius = ds * place.radius_slope;
  const Vector3d across = along - t.dot(along) * t;
  const double dstretch = stretch * stretch * place.curvature_W.dot(across);
  const double dp = (2 * Reach2() * dradius / radius - 2 * d.dot(dd)) / Radius2();
  const double dg = dd.dot(t.cross(w)) + d.dot(dt.cross(w) + t.cross(dw));
  const Vector3d dround = dd.cross(t) + d.cross(dt);
  const double c_R = speed.swirl_m_s / radius;
  const double dc_R = (ds * speed.swirl_slope_1_s - c_R * dradius) / radius;
  const double turn = 2 / Radius2() * g + c_R * p;
  const double dturn = 2 / Radius2() * (dg - 2 * g * dradius / radius) + dc_R * p + c_R * dp;
  return dstretch * bracket + stretch * (dp * w + p * dw - dturn * round - turn * dround);
}

}  // namespace

Vector3d CrossFlow::Curl_1_s() const {
  const Matrix3d& g = gradient_1_s;
  return {g(2, 1) - g(1, 2), g(0, 2) - g(2, 0), g(1, 0) - g(0, 1)};
}

CrossFlow CalcCrossFlow(const CrossPlace& place, const CrossSpeed& speed) {
  const CrossField field(place, speed);
  CrossFlow flow;
  flow.velocity_W = field.stretch * field.bracket;
  for (int j = 0; j < 3; ++j) flow.gradient_1_s.col(j) = field.CalcDerivative(Vector3d::Unit(j));
  return flow;
}

CrossAddition CalcCrossAddition(const CrossPlace& place, const CrossSpeed& speed, const AxialFlow& main,
                                const Vector3d& main_velocity_W, double change_1_s) {
  const CrossFlow cross = CalcCrossFlow(place, speed);
  const Vector3d &u2 = cross.velocity_W, &d = place.offset_W;
  const double r = d.norm(), stretch = 1 / (1 - d.dot(place.curvature_W));
  const Vector3d out = r > kOnAxis_m ? Vector3d(d / r) : Vector3d::Zero();
  const double outward = u2.dot(out), turn = stretch * place.curvature_W.dot(u2);
  const double along = stretch * (main.d_axial_dr_1_s * outward + main.axial_m_s * turn);
  const double squeeze = main.d_radial_dr_1_s() - main.radial_over_r_1_s;
  CrossAddition addition;
  addition.velocity_W = u2;
  addition.acceleration_W = cross.gradient_1_s * (main_velocity_W + u2) + along * place.axis_W +
                            main.radial_over_r_1_s * u2 + squeeze * outward * out + change_1_s * u2;
  if (speed.swirl_change_m_s2 != 0) {
    CrossSpeed change;
    change.swirl_m_s = speed.swirl_change_m_s2;  // the field is linear in it
    addition.acceleration_W += CalcCrossFlow(place, change).velocity_W;
  }
  addition.spin_W = 0.5 * cross.Curl_1_s();
  return addition;
}

}  // namespace piperun::sim
