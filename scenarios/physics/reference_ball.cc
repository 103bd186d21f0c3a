#include "scenarios/physics/reference_ball.h"

namespace piperun::scenarios::physics {
namespace {

Network MakeLine(const std::vector<Vector3d>& points, double bend_radius_m) {
  PipeSpec pipe;
  pipe.id = "P";
  pipe.from = "A";
  pipe.to = "B";
  pipe.diameter_m = 2 * ReferenceBall::bore_radius_m;
  pipe.wall_thickness_m = 0.007;
  pipe.bend_radius_m = bend_radius_m;
  pipe.vertices_m = {points.begin() + 1, points.end() - 1};
  pipe.material = {"test", 3.5e9, 0.05, 0.4, 1400, 0};
  return Network({{"A", points.front()}, {"B", points.back()}}, {pipe});
}

}  // namespace

sim::TubeBall MakeReferenceBall(double friction, double rolling_length_m) {
  return {ReferenceBall::radius_m, ReferenceBall::inertial_kg, ReferenceBall::inertia_kg_m2, friction,
          rolling_length_m};
}

PipeBench::PipeBench(const std::vector<Vector3d>& points, double bend_radius_m)
    : network_(MakeLine(points, bend_radius_m)), bore_(network_) {}

sim::BallStart PipeBench::Start(double s_m, const Vector3d& offset_W, const Vector3d& v_WB_W,
                                const Vector3d& w_WB_W) const {
  sim::BallStart start;
  start.spot.s_m = s_m;
  start.spot.piece = pipe().FindPiece(s_m);
  start.spot.axis = EvalCentreline(pipe().centreline[start.spot.piece], s_m);
  start.X_LB = {start.spot.axis.p_W + offset_W, Quaterniond::Identity()};
  start.v_WB_W = v_WB_W;
  start.w_WB_W = w_WB_W;
  return start;
}

sim::BallLoad CalcReferenceWeight(const sim::BallInstant&) {
  return {{0, 0, -ReferenceBall::weight_N}, Vector3d::Zero()};
}

}  // namespace piperun::scenarios::physics
