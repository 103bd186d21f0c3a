#include "sim/feature_shape.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/check.h"

namespace piperun::sim {
namespace {

constexpr double kSeam_m = 1e-11;  // feet of neighbouring surfaces overlap by this much
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Away from the axis, unit; on the axis any direction across.
Vector3d CalcOut(const Vector3d& off) {
  const double rho = off.norm();
  return rho > 0 ? Vector3d(off / rho) : Vector3d(0, 1, 0);
}

/// The foot on a ball of radius `radius_m` around c; none when p is c.
void AddRoundFoot(const Vector3d& from_c, double radius_m, WallFoot::Kind kind, WallFeet& feet) {
  const double distance = from_c.norm();
  if (distance > 0) feet.Add({from_c / distance, distance - radius_m, kind});
}

/// The foot on the torus around the circle x = 0, rho = R_c.
void AddTorusFoot(const Vector3d& p_G, double circle_m, double tube_m, WallFeet& feet) {
  const Vector3d out = CalcOut({0, p_G.y(), p_G.z()});
  AddRoundFoot(p_G - circle_m * out, tube_m, WallFoot::Kind::kSheet, feet);
}

void AddFeetOf(const RingBead& ring, const Vector3d& p_G, double, double ring_m, WallFeet& feet) {
  AddTorusFoot(p_G, ring.circle_radius_m, ring.tube_radius_m, feet);
  const Vector3d off(0, p_G.y(), p_G.z()), out = CalcOut(off);
  if (2 * off.norm() > ring_m) return;
  for (const int k : {1, 2}) {
    const double angle = 2 * std::numbers::pi / 3 * k;
    const Vector3d turned = std::cos(angle) * out + std::sin(angle) * Vector3d::UnitX().cross(out);
    AddRoundFoot(p_G - ring.circle_radius_m * turned, ring.tube_radius_m, WallFoot::Kind::kPlane, feet);
  }
}

void AddFeetOf(const GrooveRim& rim, const Vector3d& p_G, double, double, WallFeet& feet) {
  if (rim.side * p_G.x() < -kSeam_m) return;  // there the wall itself is nearer
  AddTorusFoot(p_G, rim.bore_radius_m + rim.edge_radius_m, rim.edge_radius_m, feet);
}

void AddFeetOf(const GrooveFloor&, const Vector3d&, double, double, WallFeet&) {}

void AddFeetOf(const OffsetSleeve& sleeve, const Vector3d& p_G, double, double, WallFeet& feet) {
  const Vector3d begin(0, -sleeve.offset_m, 0);
  const Vector3d line(sleeve.ramp_m, sleeve.offset_m, 0);
  const Vector3d axis = line.normalized(), d = p_G - begin;
  const double along = d.dot(axis);
  if (along > line.norm()) return;
  const Vector3d off = d - along * axis;
  const Vector3d out = CalcOut(off);
  if (along >= 0) {
    feet.Add({-out, sleeve.bore_radius_m - off.norm(), WallFoot::Kind::kSheet});
    return;
  }
  AddRoundFoot(d - (sleeve.bore_radius_m + sleeve.edge_radius_m) * out, sleeve.edge_radius_m,
               WallFoot::Kind::kSheet, feet);
}

void AddFeetOf(const Boss& boss, const Vector3d& p_G, double, double, WallFeet& feet) {
  AddRoundFoot(p_G - Vector3d(0, boss.centre_m, 0), boss.radius_m, WallFoot::Kind::kSheet, feet);
}

/// The gate is a plate with square corners, thinner and farther by a, grown by a.
void AddFeetOf(const GateLeaf& gate, const Vector3d& p_G, double, double, WallFeet& feet) {
  const double a = gate.edge_radius_m, flat_m = gate.half_thickness_m - a;
  const Vector3d nearest(std::clamp(p_G.x(), -flat_m, flat_m), std::max(p_G.y(), gate.edge_m + a), p_G.z());
  AddRoundFoot(p_G - nearest, a, WallFoot::Kind::kSheet, feet);
}

void AddFeetOf(const ServiceHole& hole, const Vector3d& p_G, double limit_m, double ring_m, WallFeet& feet) {
  hole.AddFeet(p_G, limit_m, ring_m, feet);
}

/// Radius of the circle through both ends of a cap and its top.
double CalcCapRadius_m(double height_m, double width_m) {
  return (height_m * height_m + 0.25 * width_m * width_m) / (2 * height_m);
}

ShapeExtent ExtentOf(const RingBead& ring) { return {-ring.half_width_m, ring.half_width_m}; }
ShapeExtent ExtentOf(const GrooveRim& rim) {
  return {std::min(0.0, rim.side * rim.edge_radius_m), std::max(0.0, rim.side * rim.edge_radius_m)};
}
ShapeExtent ExtentOf(const GrooveFloor& floor) {
  const double half_m = floor.half_width_m + floor.edge_radius_m;
  return {-half_m, half_m};
}
ShapeExtent ExtentOf(const OffsetSleeve& sleeve) {
  // leaning by e/l, the rim's circle reaches R e/l to either side
  const double lean_m = sleeve.bore_radius_m * sleeve.offset_m / sleeve.ramp_m;
  return {-sleeve.edge_radius_m - lean_m, sleeve.ramp_m + lean_m};
}
ShapeExtent ExtentOf(const Boss& boss) { return {-boss.base_m, boss.base_m}; }
ShapeExtent ExtentOf(const GateLeaf& gate) { return {-gate.half_thickness_m, gate.half_thickness_m}; }
ShapeExtent ExtentOf(const ServiceHole& hole) { return {-hole.radius_m(), hole.radius_m()}; }

}  // namespace

struct ServiceHole::Edge {
  std::vector<BoreMember> members;
  JointLip lip;
};

ServiceHole::ServiceHole(double bore_radius_m, double radius_m) : radius_m_(radius_m) {
  Demand(radius_m > 0 && radius_m < bore_radius_m, "a service hole is narrower than its pipe");
  const double beyond_m = 4 * bore_radius_m;
  std::vector<BoreMember> members{{.axis = Vector3d::UnitY(), .radius_m = radius_m},
                                  {.origin = {-beyond_m, 0, 0},
                                   .axis = Vector3d::UnitX(),
                                   .radius_m = bore_radius_m,
                                   .length_m = 2 * beyond_m}};
  JointLip lip(members, 0);
  edge_ = std::make_shared<const Edge>(Edge{std::move(members), std::move(lip)});
}

bool ServiceHole::Covers(const Vector3d& q_G) const {
  return q_G.y() > 0 && q_G.x() * q_G.x() + q_G.z() * q_G.z() < radius_m_ * radius_m_;
}

void ServiceHole::AddFeet(const Vector3d& p_G, double limit_m, double ring_m, WallFeet& feet) const {
  edge_->lip.AddFeet(edge_->members, p_G, limit_m, ring_m, feet);
}

RingBead MakeRingBead(double bore_radius_m, double height_m, double width_m) {
  const double a = CalcCapRadius_m(height_m, width_m);
  return {bore_radius_m - height_m + a, a, 0.5 * width_m};
}

Boss MakeBoss(double bore_radius_m, double height_m, double base_diameter_m) {
  const double a = CalcCapRadius_m(height_m, base_diameter_m);
  return {bore_radius_m - height_m + a, a, 0.5 * base_diameter_m};
}

ShapeExtent CalcExtent(const ShapeBody& body) {
  return std::visit([](const auto& shape) { return ExtentOf(shape); }, body);
}

void AddBodyFeet(const ShapeBody& body, const Vector3d& p_G, double limit_m, double ring_m, WallFeet& feet) {
  std::visit([&](const auto& shape) { AddFeetOf(shape, p_G, limit_m, ring_m, feet); }, body);
}

double CalcRecess_m(const ShapeBody& body, double ds_m, const Vector3d& q_G) {
  if (const auto* floor = std::get_if<GrooveFloor>(&body)) {
    if (std::abs(ds_m) < floor->half_width_m) return floor->depth_m;
    return std::abs(ds_m) < floor->half_width_m + floor->edge_radius_m ? kInfinity : 0;
  }
  const auto* hole = std::get_if<ServiceHole>(&body);
  return hole && hole->Covers(q_G) ? kInfinity : 0;
}

bool IsEdgeOfWall(const ShapeBody& body) {
  return std::holds_alternative<GrooveRim>(body) || std::holds_alternative<ServiceHole>(body);
}

}  // namespace piperun::sim
