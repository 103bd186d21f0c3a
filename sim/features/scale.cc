// A patch of scale, tubercles or sediment: lumps strewn over the wall.

#include <numbers>

#include "base/check.h"
#include "sim/wall_feature.h"

namespace piperun::sim {
namespace {

constexpr std::uint64_t kMostLumps = 20000;  // in one patch
constexpr std::uint64_t kPlaceSlot = 1, kHeightSlot = 1;

struct ScaleParams : ParamsOf<ScaleParams> {
  FeaturePlaces places;
  double length_m = 1;
  double cover = 0.2;
  ScatteredSize height{0.002, 0.0005};
  double lump_m = 0.02;

  void Visit(ParamVisitor& v) override {
    places.Visit(v);
    v.Number({"length_m", "Length of the patch along the pipe; it stands in the patch's middle."},
             {.min = 1e-3, .max = 1e4}, length_m);
    v.Number({"cover", "Area of the lumps' bases over the wall's; they may overlap."}, Range::Between(0, 1),
             cover);
    v.Number({"height_m", "How far a lump stands out of the wall."}, {.min = 0, .max = 0.5, .min_open = true},
             height.mean_m);
    v.Number({"height_sd_m", "Scatter of the height from lump to lump; a lower one is narrower."},
             Range::Between(0, 0.1), height.sd_m);
    v.Number({"lump_diameter_m", "Diameter at the wall of a lump of mean height."}, {.min = 1e-3, .max = 1},
             lump_m);
  }
  double Width_m(double height_m) const { return lump_m * height_m / height.mean_m; }
};

/// Lumps until their bases, of pi/4 b^2 each, cover as much of the wall as they shall.
WallFeature MakePatch(const ScaleParams& p, const WallFeatureSite& site, const FeaturePlaces::Place& place) {
  const double radius_m = site.At().radius_m();
  double bare_m2 = p.cover * 2 * std::numbers::pi * radius_m * p.length_m;
  WallFeature patch{site.pipe, place.s_m, {}};
  for (std::uint64_t i = 0; bare_m2 > 0; ++i) {
    if (i == kMostLumps) {
      throw InputError("a patch has at most " + std::to_string(kMostLumps) +
                           " lumps, and these do not cover that much; take larger lumps or shorter patches",
                       "cover");
    }
    const std::uint64_t sample = 2 * (place.number + 1) * kMostLumps + i;
    const auto u = site.random.Uniforms(sample, kPlaceSlot);
    const double s_m = place.s_m + (u[0] - 0.5) * p.length_m;
    const double height_m = p.height.Draw_m(site.random, sample, kHeightSlot), width_m = p.Width_m(height_m);
    if (height_m == 0) continue;
    bare_m2 -= 0.25 * std::numbers::pi * width_m * width_m;
    patch.shapes.push_back(
        {s_m, site.ClockDirection(s_m, 2 * std::numbers::pi * u[1]), MakeBoss(radius_m, height_m, width_m)});
  }
  return patch;
}

std::vector<WallFeature> Make(const Params& params, const WallFeatureSite& site) {
  const auto& p = static_cast<const ScaleParams&>(params);
  const double radius_m = site.At().radius_m(), most_m = p.height.Largest_m();
  RequireBelow(most_m, radius_m, "the bore's radius (3 sigma of the scatter counted)", "height_m");
  const Boss largest = MakeBoss(radius_m, most_m, p.Width_m(most_m));
  const double half_m = 0.5 * p.length_m + largest.base_m;
  std::vector<WallFeature> patches;
  for (const auto& place : p.places.Find(site, {half_m, half_m, false, largest.radius_m})) {
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
