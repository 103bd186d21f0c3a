#include "sim/flow_field.h"

#include <cmath>

namespace piperun::sim {
namespace {

constexpr double kOnAxis_m = 1e-12;  // closer, the direction away from the axis means nothing

}  // namespace

FlowField::FlowField(const Route& route, const FlowTimeline& flow, const WaterProperties& water,
                     double gravity_m_s2, double ball_radius_m)
    : route_(route),
      flow_(flow),
      water_(water),
      gravity_m_s2_(gravity_m_s2),
      disc_(ball_radius_m / route.pieces().front().radius_m) {}

WaterAtBall FlowField::Eval(const RouteSpot& spot, const Vector3d& p_W, TrueTime t) const {
  const RoutePiece& piece = route_.pieces()[spot.piece];
  const FlowPoint flow = flow_.Eval(piece.pipe, piece.PipeS_m(spot.chainage_m), t);
  const double bulk = piece.reversed ? -flow.velocity_m_s : flow.velocity_m_s;
  const double reynolds = 2 * piece.radius_m * std::abs(bulk) / water_.kinematic_viscosity_m2_s;

  const Vector3d d = p_W - spot.axis.p_W;
  const double offset_m = d.norm();
  const DiscMean mean =
      disc_.Eval(CalcVelocityProfile(reynolds, flow.friction_factor), offset_m / piece.radius_m);
  const double stretch = 1 / (1 - d.dot(spot.axis.curvature_W));
  const double speed = bulk * mean.velocity * stretch;

  WaterAtBall water;
  water.velocity_W = speed * spot.axis.tangent_W;
  water.acceleration_W = speed * speed * stretch * spot.axis.curvature_W;
  if (offset_m > kOnAxis_m) {
    const Vector3d gradient_W = (stretch * bulk * mean.gradient / (piece.radius_m * offset_m)) * d;
    water.spin_W = 0.5 * gradient_W.cross(spot.axis.tangent_W);
  }
  const double dynamic_pressure_Pa = 0.5 * water_.density_kg_m3 * bulk * std::abs(bulk);
  water.pressure_fall_W_Pa_m =
      flow.friction_factor / (2 * piece.radius_m) * dynamic_pressure_Pa * spot.axis.tangent_W;
  water.bulk_speed_m_s = bulk;
  water.pressure_Pa = water_.density_kg_m3 * gravity_m_s2_ * (flow.head_m - p_W.z());
  return water;
}

}  // namespace piperun::sim
