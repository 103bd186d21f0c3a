#include "sim/flow_field.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/check.h"

namespace piperun::sim {
namespace {

using std::numbers::pi;

constexpr double kOnAxis_m = 1e-12;  // closer, the direction away from the axis means nothing
constexpr double kCoreRadii = 2.5;   // of a joint's core beyond its reach
constexpr double kProfileRadii = 4;  // in which the uniform flow takes the pipe's profile on
constexpr double kWithdrawalRadii = 2;

/// The cone at a place of a pipe, or null.
const Cone* FindCone(const Pipe& pipe, double s_m) {
  if (pipe.cone_from.length_m > 0 && s_m < pipe.cone_from.length_m) return &pipe.cone_from;
  if (pipe.cone_to.length_m > 0 && pipe.length_m - s_m < pipe.cone_to.length_m) return &pipe.cone_to;
  return nullptr;
}

/// Length over which the flow changes at an end of a reach that is so long outside the joints.
double CalcWithdrawalWidth_m(const Pipe& pipe, double length_m) {
  return std::min(kWithdrawalRadii * pipe.radius_m(), 0.5 * length_m);
}

/// Rotation that takes the arm's direction here to its direction at the node: an arm that bends within its
/// joint's core is unrolled.
Matrix3d CalcUnrolling(const Vector3d& here, const Vector3d& at_node) {
  return Quaterniond::FromTwoVectors(here, at_node).toRotationMatrix();
}

}  // namespace

struct FlowField::Site {
  const NetworkSpot& spot;
  const Pipe& pipe;
  const PipeZones& zones;
  std::size_t reach = 0;  ///< of the timeline
  TrueTime time{};
  Swirl swirl{};
  FlowPoint flow{};                    ///< of the reach
  Vector3d offset = Vector3d::Zero();  ///< from the axis to the ball's centre
  double offset_m = 0;
  double stretch = 1;  ///< k
  double z_m = 0;      ///< elevation of the ball's centre

  double FromEnd_m(bool at_to) const { return at_to ? pipe.length_m - spot.s_m : spot.s_m; }
  const EndZone& zone(bool at_to) const { return at_to ? zones.to : zones.from; }
};

FlowField::FlowField(const Bore& bore, const FlowTimeline& flow, const WaterProperties& water,
                     double gravity_m_s2, double ball_radius_m, const StreamParams& stream)
    : bore_(bore),
      flow_(flow),
      water_(water),
      gravity_m_s2_(gravity_m_s2),
      ball_radius_m_(ball_radius_m),
      cross_flow_(stream.secondary_flow || stream.swirl_switching),
      secondary_(bore, stream.secondary_flow ? stream.secondary_flow_amplitude : 0),
      profile_(FindProfileLaw(stream.profile)),
      pipe_tables_(bore.network().pipes().size()),
      junctions_(bore.network().nodes().size()) {
  for (int pipe = 0; pipe < static_cast<int>(pipe_tables_.size()); ++pipe) {
    zones_.push_back(MakeZones(pipe));
    std::vector<Span>& spans = developed_.emplace_back();
    for (const FlowReach& reach : flow.reaches(pipe)) spans.push_back(CalcDevelopedSpan(pipe, reach));
  }
}

bool FlowField::HasJunction(const Joint& joint) const { return !joint.smooth && JunctionFlow::Covers(joint); }

FlowField::PipeZones FlowField::MakeZones(int pipe) const {
  const Pipe& p = bore_.network().pipe(pipe);
  PipeZones zones;
  if (!bore_.open(pipe)) return zones;
  for (const bool at_to : {false, true}) {
    const Joint& joint = bore_.joint(at_to ? p.to : p.from);
    if (!HasJunction(joint)) continue;
    const JointArm& arm = bore_.FindArm(joint, {pipe, at_to});
    const double core_m = std::min(0.5 * p.length_m, arm.reach_m + kCoreRadii * arm.radius_m);
    (at_to ? zones.to : zones.from) = {arm.reach_m, core_m, core_m};
  }
  if (zones.from.core_m == 0 && zones.to.core_m == 0) return zones;
  const bool both = zones.from.core_m > 0 && zones.to.core_m > 0;
  const double room_m = (p.length_m - zones.from.core_m - zones.to.core_m) / (both ? 2 : 1);
  const double length_m = std::clamp(room_m, 0.0, kProfileRadii * p.radius_m());
  if (both) zones.profile_share = length_m / (kProfileRadii * p.radius_m());
  if (zones.from.core_m > 0) zones.from.profile_m += length_m;
  if (zones.to.core_m > 0) zones.to.profile_m += length_m;
  return zones;
}

/// Of a reach, what lies outside the joints' cores.
FlowField::Span FlowField::CalcFlowSpan(int pipe, const FlowReach& reach) const {
  const PipeZones& zones = zones_[static_cast<std::size_t>(pipe)];
  return {std::max(reach.s_begin_m, zones.from.core_m),
          std::min(reach.s_end_m, bore_.network().pipe(pipe).length_m - zones.to.core_m)};
}

FlowField::Span FlowField::CalcDevelopedSpan(int pipe, const FlowReach& reach) const {
  const PipeZones& zones = zones_[static_cast<std::size_t>(pipe)];
  if (zones.profile_share < 1) return {0, -1};
  const Pipe& p = bore_.network().pipe(pipe);
  const Span flow = CalcFlowSpan(pipe, reach);
  const double width_m = CalcWithdrawalWidth_m(p, flow.end_m - flow.begin_m);
  return {
      std::max({reach.s_begin_m + width_m, zones.from.profile_m, p.cone_from.length_m}),
      std::min({reach.s_end_m - width_m, p.length_m - zones.to.profile_m, p.length_m - p.cone_to.length_m})};
}

FlowField::Site FlowField::MakeSite(const NetworkSpot& spot, const Vector3d& p_L, TrueTime t,
                                    const Swirl& swirl) const {
  Site site{spot, bore_.network().pipe(spot.pipe), zones_[static_cast<std::size_t>(spot.pipe)]};
  site.reach = flow_.FindReach(spot.pipe, spot.s_m);
  site.time = t;
  site.swirl = swirl;
  site.flow = flow_.EvalReach(spot.pipe, site.reach, spot.s_m, t);
  site.offset = p_L - spot.axis.p_W;
  site.offset_m = site.offset.norm();
  site.stretch = 1 / (1 - site.offset.dot(spot.axis.curvature_W));
  site.z_m = p_L.z();
  return site;
}

WaterAtBall FlowField::Eval(const NetworkSpot& spot, const Vector3d& p_L, TrueTime t,
                            const Swirl& swirl) const {
  const Site site = MakeSite(spot, p_L, t, swirl);
  WaterAtBall water = EvalMean(site);
  FillSurroundings(site, water);
  return water;
}

WaterAtBall FlowField::EvalMean(const Site& site) const {
  if (developed_[static_cast<std::size_t>(site.spot.pipe)][site.reach].Contains(site.spot.s_m)) {
    return EvalDeveloped(site);
  }
  for (const bool at_to : {false, true}) {
    const double core_m = site.zone(at_to).core_m;
    if (core_m > 0 && site.FromEnd_m(at_to) < core_m) return EvalJunction(site, at_to);
  }
  const Jet flow = CalcFlow(site), share = CalcProfileShare(site);
  const bool cone = FindCone(site.pipe, site.spot.s_m) != nullptr;
  const bool developed = !cone && share.value == 1 && flow.value == site.flow.flow_m3_s;
  return developed ? EvalDeveloped(site) : EvalShaped(site, flow, share);
}

/// The flow beyond the end of the site's reach, in the pipe's own direction; at most nodes and inside joints
/// the same.
double FlowField::FlowBeyond(const Site& site, bool at_to) const {
  const int pipe = site.spot.pipe;
  const std::size_t reaches = flow_.reaches(pipe).size();
  if (at_to ? site.reach + 1 < reaches : site.reach > 0) {
    return flow_.EvalReach(pipe, at_to ? site.reach + 1 : site.reach - 1, site.spot.s_m, site.time).flow_m3_s;
  }
  const Joint& joint = bore_.joint(at_to ? site.pipe.to : site.pipe.from);
  if (!joint.smooth) return site.flow.flow_m3_s;
  const PipeEnd here{pipe, at_to};
  const PipeEnd other = joint.arms[joint.arms[0].end == here ? 1 : 0].end;
  const double s_m = bore_.network().pipe(other.pipe).EndS_m(other.at_to);
  const double flow = flow_.Eval(other.pipe, s_m, site.time).flow_m3_s;
  return at_to == other.at_to ? -flow : flow;
}

/// Q along the axis: near an end of its reach it goes half the way to the flow beyond.
Jet FlowField::CalcFlow(const Site& site) const {
  const FlowReach& reach = flow_.reaches(site.spot.pipe)[site.reach];
  const Span span = CalcFlowSpan(site.spot.pipe, reach);
  const double width_m = CalcWithdrawalWidth_m(site.pipe, span.end_m - span.begin_m);
  Jet flow{site.flow.flow_m3_s, 0, 0};
  for (const bool at_to : {false, true}) {
    const double s_end_m = at_to ? reach.s_end_m : reach.s_begin_m;
    if (at_to ? s_end_m > span.end_m : s_end_m < span.begin_m)
      continue;  // inside a joint, which spreads it over its wall
    const double away_m = std::abs(site.spot.s_m - s_end_m);
    if (!(away_m < width_m)) continue;
    const double jump = FlowBeyond(site, at_to) - site.flow.flow_m3_s;
    if (jump == 0) continue;
    flow = flow + 0.5 * jump * CalcSmoothStep(1 - away_m / width_m, (at_to ? 1 : -1) / width_m);
  }
  return flow;
}

/// How far the pipe's profile stands in place of the uniform flow that joints deliver.
Jet FlowField::CalcProfileShare(const Site& site) const {
  for (const bool at_to : {false, true}) {
    const EndZone& zone = site.zone(at_to);
    const double past_m = site.FromEnd_m(at_to) - zone.core_m, length_m = zone.profile_m - zone.core_m;
    if (zone.core_m == 0 || past_m >= length_m) continue;
    return site.zones.profile_share * CalcSmoothStep(past_m / length_m, (at_to ? -1 : 1) / length_m);
  }
  return {site.zones.profile_share, 0, 0};
}

const DiscMeanTable& FlowField::FindOrMakeTable(double radius_m) const {
  std::unique_ptr<DiscMeanTable>& table = tables_[radius_m];
  // a cone may lead to a bore too narrow for the ball, which then stops short of it
  if (!table) table = std::make_unique<DiscMeanTable>(std::min(kMaxDiameterRatio, ball_radius_m_ / radius_m));
  return *table;
}

const FlowField::PipeTables& FlowField::Tables(int pipe) const {
  PipeTables& tables = pipe_tables_[static_cast<std::size_t>(pipe)];
  if (tables.body) return tables;
  const Pipe& p = bore_.network().pipe(pipe);
  tables.body = &FindOrMakeTable(p.radius_m());
  tables.from = p.cone_from.length_m > 0 ? &FindOrMakeTable(p.cone_from.end_radius_m) : tables.body;
  tables.to = p.cone_to.length_m > 0 ? &FindOrMakeTable(p.cone_to.end_radius_m) : tables.body;
  return tables;
}

WaterAtBall FlowField::EvalDeveloped(const Site& site) const {
  const CentrelinePoint& axis = site.spot.axis;
  const double radius_m = site.pipe.radius_m(), bulk = site.flow.velocity_m_s;
  const double reynolds = 2 * radius_m * std::abs(bulk) / water_.kinematic_viscosity_m2_s;
  const DiscMean mean = Tables(site.spot.pipe)
                            .body->Eval(CalcVelocityProfile(reynolds, site.flow.friction_factor, profile_),
                                        site.offset_m / radius_m);
  const double speed = bulk * mean.velocity * site.stretch;
  WaterAtBall water;
  water.velocity_W = speed * axis.tangent_W;
  water.acceleration_W = speed * speed * site.stretch * axis.curvature_W;
  if (site.flow.dflow_dt_m3_s2 != 0) {
    const double change = site.flow.dflow_dt_m3_s2 / site.pipe.area_m2();
    water.acceleration_W += change * mean.velocity * site.stretch * axis.tangent_W;
  }
  if (site.offset_m > kOnAxis_m) {
    const Vector3d gradient_W =
        (site.stretch * bulk * mean.gradient / (radius_m * site.offset_m)) * site.offset;
    water.spin_W = 0.5 * gradient_W.cross(axis.tangent_W);
  }
  water.bulk_speed_m_s = bulk;
  water.bore_radius_m = radius_m;
  water.pressure_Pa = water_.density_kg_m3 * gravity_m_s2_ * (site.flow.head_m - site.z_m);
  AddFriction(site, 1, water);
  AxialFlow main;
  main.axial_m_s = bulk * mean.velocity;
  main.d_axial_dr_1_s = bulk * mean.gradient / radius_m;
  AddCrossFlow(site, {site.flow.flow_m3_s, 0, 0}, {1, 0, 0}, main, water);
  return water;
}

/// What does not depend on the kind of flow; near a joint, as if the pipe went on.
void FlowField::FillSurroundings(const Site& site, WaterAtBall& water) const {
  water.axis_W = site.spot.axis.tangent_W;
  if (site.offset_m > kOnAxis_m) water.from_wall_W = -site.offset / site.offset_m;
  water.wall_gap_m = std::max(0.0, water.bore_radius_m - ball_radius_m_ - site.offset_m);
  water.friction_velocity_m_s = std::abs(water.bulk_speed_m_s) * std::sqrt(site.flow.friction_factor / 8);
}

void FlowField::AddFriction(const Site& site, double share, WaterAtBall& water) const {
  const double dynamic_pressure_Pa =
      0.5 * water_.density_kg_m3 * water.bulk_speed_m_s * std::abs(water.bulk_speed_m_s);
  water.pressure_fall_W_Pa_m = share * site.flow.friction_factor / (2 * water.bore_radius_m) *
                               dynamic_pressure_Pa * site.spot.axis.tangent_W;
}

namespace {

/// Bore radius along a pipe.
Jet CalcRadius(const Pipe& pipe, double s_m) {
  Jet radius{pipe.RadiusAt_m(s_m), 0, 0};
  if (const Cone* cone = FindCone(pipe, s_m)) {
    const double slope = (cone->end_radius_m - pipe.radius_m()) / cone->length_m;
    radius.d1 = cone == &pipe.cone_to ? slope : -slope;
  }
  return radius;
}

/// One table's part: Psi = W H(x), x = r/(R - r_ball), H the profile's stream function over the part of the
/// bore where the ball's centre can be.
StreamTerm MakeProfileTerm(const DiscMeanTable& table, const VelocityProfile& profile, const Jet& weight,
                           const Jet& scale, double r_m) {
  const double room = 1 - table.lambda(), offset = room * r_m * scale.value;
  const DiscMean mean = table.Eval(profile, offset);
  const double slope = room * room * mean.velocity;
  // on the axis H ~ slope x^2/2
  const double over_x2 =
      offset > 1e-6 ? room * room * table.EvalFlux(profile, offset) / (offset * offset) : 0.5 * slope;
  return {weight, scale, over_x2, slope, room * room * room * mean.gradient};
}

}  // namespace

/// Psi = Q/pi [(1 - a) r^2/(2 R^2) + a (w_1 H_1 + w_2 H_2)]: a the profile's share, H_1 and H_2 the tables at
/// the ends of a cone. The weights follow (1 - d/D)^2, so that a uniform profile stays uniform.
AxialFlow FlowField::CalcAxialFlow(const Site& site, const Jet& flow, const Jet& share) const {
  const double r_m = site.offset_m, s_m = site.spot.s_m;
  const Jet radius = CalcRadius(site.pipe, s_m);
  const Jet per_turn = 1 / pi * flow;
  AxialFlow result;
  if (share.value < 1) {
    const Jet uniform = per_turn - per_turn * share;
    AddStreamTerm({uniform, Inverse(radius), 0.5, 1, 0}, r_m, result);
  }
  if (share.value == 0) return result;
  const double reynolds =
      2 * std::abs(flow.value) / (pi * site.pipe.radius_m() * water_.kinematic_viscosity_m2_s);
  const VelocityProfile profile = CalcVelocityProfile(reynolds, site.flow.friction_factor, profile_);
  const PipeTables& tables = Tables(site.spot.pipe);
  const Jet room = radius - Jet{ball_radius_m_, 0, 0}, scale = Inverse(room);
  const Jet weight = per_turn * share;
  if (radius.d1 == 0) {
    AddStreamTerm(MakeProfileTerm(*tables.body, profile, weight, scale, r_m), r_m, result);
    return result;
  }
  const DiscMeanTable& wide = FindCone(site.pipe, s_m) == &site.pipe.cone_from ? *tables.from : *tables.to;
  const Jet part = room * Inverse(radius), square = part * part;
  const double body = (1 - tables.body->lambda()) * (1 - tables.body->lambda());
  const double end = (1 - wide.lambda()) * (1 - wide.lambda());
  const Jet of_end = 1 / (end - body) * (square - Jet{body, 0, 0});
  AddStreamTerm(MakeProfileTerm(*tables.body, profile, weight - weight * of_end, scale, r_m), r_m, result);
  AddStreamTerm(MakeProfileTerm(wide, profile, weight * of_end, scale, r_m), r_m, result);
  return result;
}

WaterAtBall FlowField::EvalShaped(const Site& site, const Jet& flow, const Jet& share) const {
  const AxialFlow axial = CalcAxialFlow(site, flow, share);
  const CentrelinePoint& axis = site.spot.axis;
  const double r_m = site.offset_m, radial = axial.radial_over_r_1_s * r_m;
  const Vector3d out = r_m > kOnAxis_m ? Vector3d(site.offset / r_m) : Vector3d::Zero();
  const double speed = axial.axial_m_s * site.stretch;
  const double radius_m = site.pipe.RadiusAt_m(site.spot.s_m);
  WaterAtBall water;
  water.velocity_W = speed * axis.tangent_W + radial * out;
  double along = axial.axial_m_s * axial.d_axial_ds_1_s + radial * axial.d_axial_dr_1_s;
  if (flow.value != 0) along += site.flow.dflow_dt_m3_s2 / flow.value * axial.axial_m_s;
  const double across = axial.axial_m_s * axial.d_radial_ds_1_s + radial * axial.d_radial_dr_1_s();
  water.acceleration_W =
      along * site.stretch * axis.tangent_W + across * out + speed * speed * site.stretch * axis.curvature_W;
  water.spin_W =
      0.5 * (site.stretch * axial.d_axial_dr_1_s - axial.d_radial_ds_1_s) * out.cross(axis.tangent_W);
  water.bulk_speed_m_s = flow.value / (pi * radius_m * radius_m);
  water.bore_radius_m = radius_m;
  water.pressure_Pa = water_.density_kg_m3 * gravity_m_s2_ * (site.flow.head_m - site.z_m);
  AddFriction(site, 1, water);
  AddCrossFlow(site, flow, share, axial, water);
  return water;
}

CrossSpeed FlowField::CalcCrossSpeed(const Site& site, const Jet& bulk) const {
  const CrossGrowth growth = secondary_.Eval(site.spot, bulk.value < 0);
  const CrossStrength &strength = growth.strength, &slope = growth.slope_1_m;
  const double speed = std::abs(bulk.value), change = bulk.value < 0 ? -bulk.d1 : bulk.d1;
  const double swirl = kSwirlSpeed * site.swirl.s;
  return {speed * strength.cells_W, change * strength.cells_W + speed * slope.cells_W,
          swirl * speed * strength.swirl, swirl * (change * strength.swirl + speed * slope.swirl),
          kSwirlSpeed * site.swirl.ds_dt_1_s * speed * strength.swirl};
}

void FlowField::AddCrossFlow(const Site& site, const Jet& flow, const Jet& share, const AxialFlow& main,
                             WaterAtBall& water) const {
  if (!cross_flow_ || flow.value == 0 || share.value == 0) return;
  if (!secondary_.IsFelt(site.spot, flow.value < 0)) return;
  const Jet radius = CalcRadius(site.pipe, site.spot.s_m);
  const Jet bulk = share * (1 / pi * flow) * Inverse(radius * radius);
  const CrossSpeed speed = CalcCrossSpeed(site, bulk);
  if (!speed.Matters()) return;
  const CentrelinePoint& axis = site.spot.axis;
  const CrossPlace place{axis.tangent_W, axis.curvature_W, site.offset,
                         radius.value,   radius.d1,        ball_radius_m_};
  const CrossAddition addition =
      CalcCrossAddition(place, speed, main, water.velocity_W, site.flow.dflow_dt_m3_s2 / flow.value);
  water.velocity_W += addition.velocity_W;
  water.acceleration_W += addition.acceleration_W;
  water.spin_W += addition.spin_W;
}

FlowField::Junction& FlowField::FindOrMakeJunction(int node) const {
  std::unique_ptr<Junction>& junction = junctions_[static_cast<std::size_t>(node)];
  if (junction) return *junction;
  const Joint& joint = bore_.joint(node);
  std::vector<double> core_m;
  for (const JointArm& arm : joint.arms) {
    const PipeZones& zones = zones_[static_cast<std::size_t>(arm.end.pipe)];
    core_m.push_back(arm.end.at_to ? zones.to.core_m : zones.from.core_m);
  }
  const std::vector<double> zero(joint.arms.size());
  junction = std::make_unique<Junction>(Junction{JunctionFlow(joint, core_m), zero, zero});
  return *junction;
}

const JunctionFlow* FlowField::FindJunction(int node) const {
  return HasJunction(bore_.joint(node)) ? &FindOrMakeJunction(node).flow : nullptr;
}

/// What flows through the arms' end sections; a leak within the core counts as taken by the joint.
void FlowField::SetOutflows(const Joint& joint, TrueTime t, Junction& junction) const {
  for (std::size_t i = 0; i < joint.arms.size(); ++i) {
    const PipeEnd& end = joint.arms[i].end;
    const PipeZones& zones = zones_[static_cast<std::size_t>(end.pipe)];
    const double s_m =
        end.at_to ? bore_.network().pipe(end.pipe).length_m - zones.to.core_m : zones.from.core_m;
    const FlowPoint point = flow_.Eval(end.pipe, s_m, t);
    const double sign = end.at_to ? -1 : 1;
    junction.outflow_m3_s[i] = sign * point.flow_m3_s;
    junction.outflow_change_m3_s2[i] = sign * point.dflow_dt_m3_s2;
  }
}

WaterAtBall FlowField::EvalJunction(const Site& site, bool at_to) const {
  const int node = at_to ? site.pipe.to : site.pipe.from;
  const Joint& joint = bore_.joint(node);
  Junction& junction = FindOrMakeJunction(node);
  SetOutflows(joint, site.time, junction);
  const JointArm& arm = bore_.FindArm(joint, {site.spot.pipe, at_to});
  const auto index = static_cast<std::size_t>(&arm - joint.arms.data());
  const Vector3d along = (at_to ? -1 : 1) * site.spot.axis.tangent_W;
  const Matrix3d unroll = CalcUnrolling(along, arm.outward);
  const double from_end_m = site.FromEnd_m(at_to);
  const Vector3d p_N = from_end_m * arm.outward + unroll * site.offset;

  const VelocityGradient flow = junction.flow.Eval(junction.outflow_m3_s, index, p_N);
  const Vector3d change = junction.flow.EvalVelocity(junction.outflow_change_m3_s2, index, p_N);
  const Matrix3d& g = flow.gradient_1_s;
  const Vector3d spin(0.5 * (g(2, 1) - g(1, 2)), 0.5 * (g(0, 2) - g(2, 0)), 0.5 * (g(1, 0) - g(0, 1)));
  WaterAtBall water;
  water.velocity_W = unroll.transpose() * flow.velocity_m_s;
  water.acceleration_W = unroll.transpose() * (g * flow.velocity_m_s + change) +
                         water.velocity_W.squaredNorm() * site.spot.axis.curvature_W;
  water.spin_W = unroll.transpose() * spin;

  FillJunctionScalars(site, at_to, junction.outflow_m3_s[index], water);
  return water;
}

/// Within reach of the other arms: the node's head, no friction, the widest bore. From there to the core's
/// end all three go over into the pipe's own.
void FlowField::FillJunctionScalars(const Site& site, bool at_to, double outflow_m3_s,
                                    WaterAtBall& water) const {
  const EndZone& zone = site.zone(at_to);
  const Joint& joint = bore_.joint(at_to ? site.pipe.to : site.pipe.from);
  const double near_m = std::min(zone.reach_m, 0.5 * zone.core_m);
  const double past = CalcSmoothStep((site.FromEnd_m(at_to) - near_m) / (zone.core_m - near_m), 1).value;
  const double s_node_m = site.pipe.EndS_m(at_to);
  const double s_core_m = s_node_m + (at_to ? -zone.core_m : zone.core_m);
  const double head_m = std::lerp(flow_.Eval(site.spot.pipe, s_node_m, site.time).head_m,
                                  flow_.Eval(site.spot.pipe, s_core_m, site.time).head_m, past);
  const double radius_m = site.pipe.RadiusAt_m(s_node_m);
  water.bore_radius_m = std::lerp(joint.sphere_radius_m, radius_m, past);
  water.bulk_speed_m_s = (at_to ? -1 : 1) * outflow_m3_s / (pi * radius_m * radius_m);
  water.pressure_Pa = water_.density_kg_m3 * gravity_m_s2_ * (head_m - site.z_m);
  AddFriction(site, past, water);
}

}  // namespace piperun::sim
