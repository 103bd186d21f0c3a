#include "sim/secondary_flow.h"

#include <algorithm>
#include <cmath>

namespace piperun::sim {
namespace {

constexpr double kGrowthDiameters = 1;
constexpr double kDecayDiameters = 5;
constexpr double kFeltDiameters = 40 * kDecayDiameters;  // 4e-18 is left
constexpr double kSharpDiameters = 1.5;                  // radius of a bend whose secondary flow is full

}  // namespace

SecondaryFlow::SecondaryFlow(const Bore& bore, double amplitude)
    : bore_(bore), amplitude_(amplitude), ways_(bore.network().pipes().size()) {}

/// In a bend the components of a along the bend's normal and binormal relax, each by itself.
CrossGrowth SecondaryFlow::EvalPiece(const Pipe& pipe, std::size_t index, const Entry& from, double s_m,
                                     const CentrelinePoint& axis, bool reversed) const {
  const CrossStrength& entry = from.strength;
  const CentrelinePiece& piece = pipe.centreline[index];
  const double sign = reversed ? -1 : 1, s_entry_m = reversed ? piece.s_end_m() : piece.s_begin_m;
  const double x_m = sign * (s_m - s_entry_m);
  const double length_m = (piece.straight() ? kDecayDiameters : kGrowthDiameters) * pipe.diameter_m;
  const double left = std::exp(-x_m / length_m), slope = -sign * left / length_m;
  CrossGrowth growth;
  if (piece.straight()) {
    growth.strength = {left * entry.cells_W, left * entry.swirl};
    growth.slope_1_m = {slope * entry.cells_W, slope * entry.swirl};
    return growth;
  }
  const double sharpness = std::min(1.0, kSharpDiameters * pipe.diameter_m * piece.curvature_1_m);
  const Vector3d n = axis.curvature_W / piece.curvature_1_m, b = axis.tangent_W.cross(n);
  const double goal = -amplitude_ * sharpness;
  const double along_n = entry.cells_W.dot(from.normal_W) - goal;
  const double along_b = entry.cells_W.dot(b);
  const double at_n = goal + left * along_n;
  growth.strength.cells_W = at_n * n + left * along_b * b;
  growth.slope_1_m.cells_W =
      slope * (along_n * n + along_b * b) - at_n * piece.curvature_1_m * axis.tangent_W;
  growth.strength.swirl = sharpness + left * (entry.swirl - sharpness);
  growth.slope_1_m.swirl = slope * (entry.swirl - sharpness);
  return growth;
}

CrossStrength SecondaryFlow::CalcEntry(int pipe, bool reversed) const {
  const Pipe& here = bore_.network().pipe(pipe);
  const Joint& joint = bore_.joint(reversed ? here.to : here.from);
  if (!joint.smooth) return {};
  const PipeEnd end{pipe, reversed};
  const PipeEnd before = joint.arms[joint.arms[0].end == end ? 1 : 0].end;
  return FindOrMakeWay(before.pipe, !before.at_to).exit;
}

SecondaryFlow::Way& SecondaryFlow::FindOrMakeWay(int pipe, bool reversed) const {
  Way& way = ways_[static_cast<std::size_t>(pipe)][reversed ? 1 : 0];
  if (way.visited) return way;
  way.visited = true;
  way.exit = CalcEntry(pipe, reversed);
  const Pipe& p = bore_.network().pipe(pipe);
  const std::size_t count = p.centreline.size();
  way.entry.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t index = reversed ? count - 1 - i : i;
    const CentrelinePiece& piece = p.centreline[index];
    const auto at = [&](bool end) { return end ? piece.s_end_m() : piece.s_begin_m; };
    Entry& entry = way.entry[index];
    entry.strength = way.exit;
    if (!piece.straight()) {
      entry.normal_W = EvalCentreline(piece, at(reversed)).curvature_W / piece.curvature_1_m;
    }
    const double s_m = at(!reversed);
    way.exit = EvalPiece(p, index, entry, s_m, EvalCentreline(piece, s_m), reversed).strength;
  }
  return way;
}

bool SecondaryFlow::IsFelt(const NetworkSpot& spot, bool reversed) const {
  const Pipe& pipe = bore_.network().pipe(spot.pipe);
  const CentrelinePiece& piece = pipe.centreline[spot.piece];
  if (!piece.straight()) return true;
  const double from_entry_m = reversed ? piece.s_end_m() - spot.s_m : spot.s_m - piece.s_begin_m;
  return from_entry_m < kFeltDiameters * pipe.diameter_m &&
         !FindOrMakeWay(spot.pipe, reversed).entry[spot.piece].strength.IsZero();
}

CrossGrowth SecondaryFlow::Eval(const NetworkSpot& spot, bool reversed) const {
  const Way& way = FindOrMakeWay(spot.pipe, reversed);
  return EvalPiece(bore_.network().pipe(spot.pipe), spot.piece, way.entry[spot.piece], spot.s_m, spot.axis,
                   reversed);
}

}  // namespace piperun::sim
