// The bead that a butt weld leaves inside a pipe of steel or polyethylene.

#include "sim/wall_feature.h"

namespace piperun::sim {
namespace {

struct WeldBeadParams : ParamsOf<WeldBeadParams> {
  FeaturePlaces places;
  ScatteredSize height{0.002, 0};
  double width_m = 0.008;

  void Visit(ParamVisitor& v) override {
    places.Visit(v);
    v.Number({"height_m", "How far it stands out of the wall, all around."},
             {.min = 0, .max = 0.5, .min_open = true}, height.mean_m);
    v.Number({"height_sd_m", "Scatter of the height from bead to bead; a lower one is narrower."},
             Range::Between(0, 0.1), height.sd_m);
    v.Number({"width_m", "Its width at the wall, along the pipe."}, {.min = 1e-4, .max = 1}, width_m);
  }
};

std::vector<WallFeature> Make(const Params& params, const WallFeatureSite& site) {
  const auto& p = static_cast<const WeldBeadParams&>(params);
  const double radius_m = site.At().radius_m(), most_m = p.height.Largest_m();
  RequireBelow(most_m, radius_m, "the bore's radius (3 sigma of the scatter counted)", "height_m");
  const double aspect = p.width_m / p.height.mean_m, half_m = 0.5 * aspect * most_m;
  const RingBead largest = MakeRingBead(radius_m, most_m, aspect * most_m);
  std::vector<WallFeature> beads;
  for (const auto& [s_m, number] : p.places.Find(site, {half_m, half_m, false, largest.tube_radius_m})) {
    const double height_m = p.height.Draw_m(site.random, number, 0);
    if (height_m == 0) continue;  // ground flush
    const RingBead bead = MakeRingBead(radius_m, height_m, aspect * height_m);
    beads.push_back({site.pipe, s_m, {{s_m, site.ClockDirection(s_m, 0), bead}}});
  }
  return beads;
}

}  // namespace

namespace features::weld_bead {
WallFeatureKind Kind() {
  return {"weld_bead", "A butt weld's bead all around the bore.", MakeParams<WeldBeadParams>, Make};
}
}  // namespace features::weld_bead

}  // namespace piperun::sim
