// A patch of scale, tubercles or sediment: lumps strewn over the wall.

#include <cmath>
#include <numbers>

#include "base/check.h"
#include "base/number.h"
#include "sim/wall_feature.h"

namespace piperun::sim {
namespace {

constexpr double kMostLumps = 20000;  // in one patch
constexpr std::uint64_t kPlaceSlot = 1, kHeightSlot = 1;

struct ScaleParams : ParamsOf<ScaleParams> {
  FeaturePlaces places;
  double length_m = 1;
  double cover = 0.2;
  ScatteredSize height{0.002, 0.001};
  double lump_m = 0.02;

  void Visit(ParamVisitor& v) override {
    places.Visit(v);
    v.Number({"length_m", "Length of the patch along the pipe; it stands in the patch's middle."},
             {.min = 1e-3, .max = 1e4}, length_m);
    v.Number({"cover", "Area of the lumps' bases over the wall's; they may overlap."}, Range::Between(0, 1),
             cover);
    v.Number({"height_m", "How far a lump stands out of the wall."}, Range::Between(0, 0.5), height.mean_m);
    v.Number({"height_sd_m", "Scatter of the height from lump to lump."}, Range::Between(0, 0.1),
             height.sd_m);
    v.Number({"lump_diameter_m", "Diameter of a lump at the wall."}, {.min = 1e-3, .max = 1}, lump_m);
  }
};

/// How many lumps cover that much of the wall.
std::uint64_t CountLumps(const ScaleParams& p, double bore_radius_m) {
  const double count = p.cover * 2 * bore_radius_m * p.length_m / (0.25 * p.lump_m * p.lump_m);
  if (count > kMostLumps) {
    throw InputError("this patch has " + FormatNumber(std::round(count)) + " lumps; allowed: up to " +
                         FormatNumber(kMostLumps) + "; take larger lumps or several patches",
                     "cover");
  }
  return static_cast<std::uint64_t>(std::llround(count));
}

/// A cap of height h on a base of diameter b: a = (h^2 + (b/2)^2) / 2h.
Boss MakeLump(double bore_radius_m, double height_m, double diameter_m) {
  const double a = (height_m * height_m + 0.25 * diameter_m * diameter_m) / (2 * height_m);
  return {bore_radius_m - height_m + a, a};
}

WallFeature MakePatch(const ScaleParams& p, const WallFeatureSite& site, const FeaturePlaces::Place& place) {
  const double radius_m = site.At().radius_m();
  const std::uint64_t lumps = CountLumps(p, radius_m);
  WallFeature patch{site.pipe, place.s_m, {}};
  for (std::uint64_t i = 0; i < lumps; ++i) {
    const std::uint64_t sample = (place.number + 1) * static_cast<std::uint64_t>(kMostLumps) * 2 + i;
    const auto u = site.random.Uniforms(sample, kPlaceSlot);
    const double s_m = place.s_m + (u[0] - 0.5) * p.length_m;
    const double height_m = p.height.Draw_m(site.random, sample, kHeightSlot);
    if (height_m == 0) continue;
    patch.shapes.push_back(
        {s_m, site.ClockDirection(s_m, 2 * std::numbers::pi * u[1]), MakeLump(radius_m, height_m, p.lump_m)});
  }
  return patch;
}

std::vector<WallFeature> Make(const Params& params, const WallFeatureSite& site) {
  const auto& p = static_cast<const ScaleParams&>(params);
  RequireBelow(p.height.Largest_m(), site.At().radius_m(), "the bore's radius", "height_m");
  const double half_m = 0.5 * (p.length_m + p.lump_m);
  std::vector<WallFeature> patches;
  for (const auto& place : p.places.Find(site, {half_m, half_m})) {
    WallFeature patch = MakePatch(p, site, place);
    if (!patch.shapes.empty()) patches.push_back(std::move(patch));
  }
  return patches;
}

}  // namespace

namespace features::scale {
WallFeatureKind Kind() {
  return {"scale", "A patch of scale: round lumps at random places of the wall.", MakeParams<ScaleParams>,
          Make};
}
}  // namespace features::scale

}  // namespace piperun::sim
