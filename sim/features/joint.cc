// The joint between two sticks of pipe: a gap in the wall, and the next stick out of line.

#include <algorithm>
#include <numbers>

#include "sim/wall_feature.h"

namespace piperun::sim {
namespace {

enum Slot : std::uint64_t { kGap, kOffset, kDirection };

struct JointParams : ParamsOf<JointParams> {
  FeaturePlaces places;
  ScatteredSize gap{0.005, 0};
  double depth_m = 0.008;
  ScatteredSize offset{0, 0};
  double edge_radius_m = 0.001;
  double ramp_m = 0.3;

  void Visit(ParamVisitor& v) override {
    places.Visit(v);
    v.Number({"gap_m", "Width of the gap between the sticks' ends."}, Range::Between(0, 0.5), gap.mean_m);
    v.Number({"gap_sd_m", "Scatter of the gap from joint to joint."}, Range::Between(0, 0.1), gap.sd_m);
    v.Number({"depth_m", "How far behind the wall the gap's floor lies."}, {.min = 1e-4, .max = 0.5},
             depth_m);
    v.Number({"offset_m", "How far the next stick's end is out of line, in any direction."},
             Range::Between(0, 0.5), offset.mean_m);
    v.Number({"offset_sd_m", "Scatter of the offset from joint to joint."}, Range::Between(0, 0.1),
             offset.sd_m);
    v.Number({"edge_radius_m", "Rounding of the sticks' edges."}, Range::Between(0, 0.05), edge_radius_m);
    v.Number({"ramp_m", "Length over which the next stick leads back into line."}, {.min = 0.05, .max = 20},
             ramp_m);
  }
};

void Check(const JointParams& p, const WallFeatureSite& site) {
  RequireBelow(p.gap.Largest_m() + 2 * p.edge_radius_m, 2 * site.ball_radius_m,
               "the ball's diameter (rounded edges and 3 sigma of the scatter counted)", "gap_m");
  RequireBelow(p.offset.Largest_m(), std::min(site.At().radius_m(), p.ramp_m),
               "the bore's radius and the ramp (3 sigma of the scatter counted)", "offset_m");
}

WallFeature MakeJoint(const JointParams& p, const WallFeatureSite& site, const FeaturePlaces::Place& place) {
  const double gap_m = p.gap.Draw_m(site.random, place.number, kGap);
  const double offset_m = p.offset.Draw_m(site.random, place.number, kOffset);
  const double turn = site.random.Uniforms(place.number, kDirection + 1)[0];
  const Vector3d towards_W = site.ClockDirection(place.s_m, 2 * std::numbers::pi * turn);
  const double radius_m = site.At().radius_m(), a = p.edge_radius_m, rim_m = 0.5 * gap_m + a;
  WallFeature joint{site.pipe, place.s_m, {}};
  if (gap_m > 0) {
    joint.shapes.push_back({place.s_m, towards_W, GrooveFloor{0.5 * gap_m, a, p.depth_m}});
    joint.shapes.push_back({place.s_m - rim_m, towards_W, GrooveRim{radius_m, a, 1}});
    joint.shapes.push_back({place.s_m + rim_m, towards_W, GrooveRim{radius_m, a, -1}});
  }
  if (offset_m > 0) {
    joint.shapes.push_back({place.s_m + rim_m, towards_W, OffsetSleeve{radius_m, a, offset_m, p.ramp_m}});
  }
  return joint;
}

std::vector<WallFeature> Make(const Params& params, const WallFeatureSite& site) {
  const auto& p = static_cast<const JointParams&>(params);
  Check(p, site);
  const double rim_m = 0.5 * p.gap.Largest_m() + p.edge_radius_m;
  const bool offset = p.offset.Largest_m() > 0;
  std::vector<WallFeature> joints;
  for (const auto& place : p.places.Find(site, {rim_m, rim_m + (offset ? p.ramp_m : 0), offset})) {
    WallFeature joint = MakeJoint(p, site, place);
    if (!joint.shapes.empty()) joints.push_back(std::move(joint));
  }
  return joints;
}

}  // namespace

namespace features::joint {
WallFeatureKind Kind() {
  return {"joint", "A joint of two sticks of pipe: a gap, and the next stick out of line.",
          MakeParams<JointParams>, Make};
}
}  // namespace features::joint

}  // namespace piperun::sim
