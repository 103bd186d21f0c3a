// A partly closed valve: a gate with a straight edge.

#include "sim/wall_feature.h"

namespace piperun::sim {
namespace {

struct GateValveParams : ParamsOf<GateValveParams> {
  FeaturePlaces places;
  double opening_m = 0.1;
  double thickness_m = 0.02;
  double edge_radius_m = 0.003;
  double clock_rad = 0;

  void Visit(ParamVisitor& v) override {
    places.Visit(v);
    v.Number({"opening_m", "Height left between the gate's edge and the wall across from its stem."},
             {.min = 0, .max = 10, .min_open = true}, opening_m);
    v.Number({"thickness_m", "Thickness of the gate along the pipe."}, {.min = 1e-3, .max = 1}, thickness_m);
    v.Number({"edge_radius_m", "Rounding of its edge, at most half the thickness."}, Range::Between(0, 0.5),
             edge_radius_m);
    v.Number({"clock_rad", "Where the stem is: 0 up, clockwise seen along the pipe."}, Range::Between(-7, 7),
             clock_rad);
  }
};

std::vector<WallFeature> Make(const Params& params, const WallFeatureSite& site) {
  const auto& p = static_cast<const GateValveParams&>(params);
  const double half_m = 0.5 * p.thickness_m, radius_m = site.At().radius_m();
  RequireBelow(p.opening_m, 2 * radius_m, "the bore: such a valve is open", "opening_m");
  if (p.edge_radius_m != half_m) {
    RequireBelow(p.edge_radius_m, half_m, "half the thickness", "edge_radius_m");
  }
  const GateLeaf gate{p.opening_m - radius_m, half_m, p.edge_radius_m};
  std::vector<WallFeature> valves;
  for (const auto& [s_m, number] : p.places.Find(site, {half_m, half_m})) {
    valves.push_back({site.pipe, s_m, {{s_m, site.ClockDirection(s_m, p.clock_rad), gate}}});
  }
  return valves;
}

}  // namespace

namespace features::gate_valve {
WallFeatureKind Kind() {
  return {"gate_valve", "A partly closed valve: a gate that leaves an opening of some height.",
          MakeParams<GateValveParams>, Make};
}
}  // namespace features::gate_valve

}  // namespace piperun::sim
