#include "sim/cross_flow.h"

namespace piperun::sim {
namespace {

constexpr double kOnAxis_m = 1e-12;  // closer, the direction away from the axis means nothing

/// The flow across the pipe at one place, ready to be differentiated.
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
  Matrix3d CalcGradient() const;
};

/// By the chain rule over s, t, d, w, c and R; grad_x: of x.
Matrix3d CrossField::CalcGradient() const {
  const Vector3d &t = place.axis_W, &d = place.offset_W, &kappa = place.curvature_W;
  const Vector3d &w = speed.cells_W_m_s, &dw_ds = speed.cells_slope_W_1_s;
  const double radius = place.radius_m, c_R = speed.swirl_m_s / radius;
  const Vector3d grad_s = stretch * t, grad_radius = place.radius_slope * grad_s;
  const Vector3d grad_stretch = stretch * stretch * (kappa - t.dot(kappa) * t);
  const Vector3d grad_d2 = 2 * (d - d.dot(t) * grad_s);
  const Vector3d grad_p = (2 * Reach2() / radius * grad_radius - grad_d2) / Radius2();
  const Vector3d grad_g = t.cross(w) + d.dot(kappa.cross(w) + t.cross(dw_ds)) * grad_s;
  const Vector3d grad_c_R = (speed.swirl_slope_1_s * grad_s - c_R * grad_radius) / radius;
  const double turn = 2 / Radius2() * g + c_R * p;
  const Vector3d grad_turn =
      2 / Radius2() * (grad_g - 2 * g / radius * grad_radius) + p * grad_c_R + c_R * grad_p;
  const Matrix3d grad_round = d.cross(kappa) * grad_s.transpose() - Skew(t);
  return bracket * grad_stretch.transpose() +
         stretch * (w * grad_p.transpose() + p * dw_ds * grad_s.transpose() - round * grad_turn.transpose() -
                    turn * grad_round);
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
  flow.gradient_1_s = field.CalcGradient();
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
