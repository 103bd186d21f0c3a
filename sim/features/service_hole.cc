// The hole where a service pipe is tapped into a main.

#include "sim/wall_feature.h"

namespace piperun::sim {
namespace {

struct ServiceHoleParams : ParamsOf<ServiceHoleParams> {
  FeaturePlaces places;
  double diameter_m = 0.02;
  double clock_rad = 0;
  double clock_sd_rad = 0;

  void Visit(ParamVisitor& v) override {
    places.Visit(v);
    v.Number({"diameter_m", "Diameter of the hole."}, {.min = 1e-3, .max = 1}, diameter_m);
    v.Number({"clock_rad", "Where it is: 0 up, clockwise seen along the pipe."}, Range::Between(-7, 7),
             clock_rad);
    v.Number({"clock_sd_rad", "Scatter of that from hole to hole."}, Range::Between(0, 3), clock_sd_rad);
  }
};

std::vector<WallFeature> Make(const Params& params, const WallFeatureSite& site) {
  const auto& p = static_cast<const ServiceHoleParams&>(params);
  const double radius_m = 0.5 * p.diameter_m;
  RequireBelow(p.diameter_m, 2 * site.ball_radius_m, "the ball's diameter; a wider hole is a pipe of its own",
               "diameter_m");
  RequireBelow(p.diameter_m, 2 * site.At().radius_m(), "the bore", "diameter_m");
  const ServiceHole hole(site.At().radius_m(), radius_m);
  std::vector<WallFeature> holes;
  for (const auto& [s_m, number] : p.places.Find(site, {radius_m, radius_m, true})) {
    const double clock_rad = p.clock_rad + p.clock_sd_rad * site.random.Normals(number, 1)[0];
    holes.push_back({site.pipe, s_m, {{s_m, site.ClockDirection(s_m, clock_rad), hole}}});
  }
  return holes;
}

}  // namespace

namespace features::service_hole {
WallFeatureKind Kind() {
  return {"service_hole", "The hole of a service pipe's tapping, with a sharp edge.",
          MakeParams<ServiceHoleParams>, Make};
}
}  // namespace features::service_hole

}  // namespace piperun::sim
