#include "scenarios/inp_network.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/check.h"
#include "base/number.h"
#include "scenarios/materials.h"
#include "sim/network/water_way.h"

namespace piperun::scenarios {
namespace {

using Eigen::Vector2d;
using sim::HydraulicModel;
using sim::MapPoint;

constexpr double kLengthOverBore = 2;  // of pumps and valves
constexpr double kLengthOverRise = 1.2;

template <class T>
const auto& At(const T& items, int i) {
  return items[static_cast<std::size_t>(i)];
}

const std::optional<MapPoint>& PositionOf(const HydraulicModel& model, int node) {
  if (node < model.junction_count()) return At(model.junctions, node).position;
  if (node < model.first_tank()) return At(model.reservoirs, node - model.junction_count()).position;
  return At(model.tanks, node - model.first_tank()).position;
}

const std::vector<MapPoint>& VerticesOf(const HydraulicModel& model, int link) {
  if (link < model.first_pump()) return At(model.pipes, link).vertices;
  if (link < model.first_valve()) return At(model.pumps, link - model.first_pump()).vertices;
  return At(model.valves, link - model.first_valve()).vertices;
}

bool IsReservoir(const HydraulicModel& model, int node) {
  return node >= model.junction_count() && node < model.first_tank();
}

void RequireCoordinates(const HydraulicModel& model) {
  int missing = 0;
  std::string first;
  for (int node = 0; node < model.node_count(); ++node) {
    if (PositionOf(model, node)) continue;
    if (missing++ == 0) first = model.NodeId(node);
  }
  if (missing == 0) return;
  throw InputError(std::to_string(missing) + " of " + std::to_string(model.node_count()) +
                       " nodes have no coordinates, the first is '" + first +
                       "'; a ball needs a drawing: add them in [COORDINATES]",
                   "network.inp", model.name);
}

/// The drawing of a file in its own units.
struct Map {
  std::vector<Vector2d> nodes;
  std::vector<std::vector<Vector2d>> lines;  ///< per link, ends included
};

Map MakeMap(const HydraulicModel& model) {
  Map map;
  for (int node = 0; node < model.node_count(); ++node) {
    const MapPoint& p = *PositionOf(model, node);
    map.nodes.emplace_back(p.x, p.y);
  }
  for (int link = 0; link < model.link_count(); ++link) {
    std::vector<Vector2d> line{At(map.nodes, model.From(link))};
    for (const MapPoint& p : VerticesOf(model, link)) line.emplace_back(p.x, p.y);
    line.push_back(At(map.nodes, model.To(link)));
    map.lines.push_back(std::move(line));
  }
  return map;
}

double CalcDrawnLength(const std::vector<Vector2d>& line) {
  double sum = 0;
  for (std::size_t i = 0; i + 1 < line.size(); ++i) sum += (line[i + 1] - line[i]).norm();
  return sum;
}

Vector2d FindLowerLeft(const Map& map) {
  Vector2d corner = map.nodes.front();
  for (const auto& line : map.lines) {
    for (const Vector2d& p : line) corner = corner.cwiseMin(p);
  }
  return corner;
}

/// Elevation of every node's pipes.
std::vector<double> CalcElevations_m(const HydraulicModel& model) {
  std::vector<double> z_m;
  for (int node = 0; node < model.node_count(); ++node) z_m.push_back(model.Elevation_m(node));
  const std::vector<double> given_m = z_m;
  for (int link = 0; link < model.link_count(); ++link) {
    for (const auto& [node, other] :
         {std::pair{model.From(link), model.To(link)}, {model.To(link), model.From(link)}}) {
      if (!IsReservoir(model, node) || IsReservoir(model, other)) continue;
      double& z = z_m[static_cast<std::size_t>(node)];
      z = std::min(z, At(given_m, other));
    }
  }
  return z_m;
}

/// Metres per unit of the map as each pipe has it, in rising order.
std::vector<double> CalcMapUnits_m(const HydraulicModel& model, const Map& map,
                                   const std::vector<double>& z_m) {
  std::vector<double> units_m;
  for (int i = 0; i < model.first_pump(); ++i) {
    const sim::PipeLink& pipe = At(model.pipes, i);
    const double rise_m = At(z_m, pipe.to) - At(z_m, pipe.from);
    const double run2_m2 = pipe.length_m * pipe.length_m - rise_m * rise_m;
    const double drawn = CalcDrawnLength(At(map.lines, i));
    if (drawn > 0 && run2_m2 > 0) units_m.push_back(std::sqrt(run2_m2) / drawn);
  }
  std::sort(units_m.begin(), units_m.end());
  return units_m;
}

/// The value below which a share of the sorted values lies.
double Quantile(const std::vector<double>& sorted, double share) {
  const double place = share * static_cast<double>(sorted.size() - 1);
  const auto i = static_cast<std::size_t>(place);
  const double next = sorted[std::min(i + 1, sorted.size() - 1)];
  return std::lerp(sorted[i], next, place - static_cast<double>(i));
}

double FitMapUnit_m(const std::vector<double>& units_m, const HydraulicModel& model,
                    std::vector<std::string>& notes) {
  if (units_m.empty()) {
    throw InputError("no pipe has both a drawn and a stated length, so the map has no scale; give map_unit_m",
                     "network.map_unit_m", model.name);
  }
  const double median_m = Quantile(units_m, 0.5);
  const double low = Quantile(units_m, 0.05) / median_m, high = Quantile(units_m, 0.95) / median_m;
  notes.push_back("a unit of the map is taken as " + FormatDigits(median_m, 4) +
                  " m: the median of stated over drawn length of " + std::to_string(units_m.size()) +
                  " pipes; nine in ten of them lie between " + FormatDigits(low, 4) + " and " +
                  FormatDigits(high, 4) + " times that (map_unit_m sets it)");
  return median_m;
}

/// Puts a file's elements into the entries of a scenario.
class Drawer {
 public:
  Drawer(const HydraulicModel& model, const DrawingParams& params)
      : model_(model), params_(params), map_(MakeMap(model)), z_m_(CalcElevations_m(model)) {}

  InpDrawing Draw();

 private:
  NodeEntry MakeNode(int node) const;
  PipeEntry MakeEntry(int link, const std::string& id, double diameter_m) const;
  void SetLine(int link, PipeEntry& entry) const;
  void SetWall(const PipeTraits& traits, PipeEntry& entry) const;
  double CalcFittingLength_m(int link, double diameter_m) const;
  double FindNarrowestBeside_m(int pump) const;
  PipeEntry MakePipe(int i) const;
  PipeEntry MakePump(int i) const;
  PipeEntry MakeValve(int i) const;
  void AddNotes(std::vector<std::string>& notes) const;

  const HydraulicModel& model_;
  const DrawingParams& params_;
  Map map_;
  std::vector<double> z_m_;  // per node
  Vector2d corner_ = Vector2d::Zero();
  double unit_m_ = 1;
};

InpDrawing Drawer::Draw() {
  InpDrawing drawing;
  corner_ = FindLowerLeft(map_);
  unit_m_ = params_.map_unit_m ? *params_.map_unit_m
                               : FitMapUnit_m(CalcMapUnits_m(model_, map_, z_m_), model_, drawing.notes);
  for (int i = 0; i < model_.node_count(); ++i) drawing.network.nodes.push_back(MakeNode(i));
  std::vector<PipeEntry>& pipes = drawing.network.pipes;
  for (int i = 0; i < model_.first_pump(); ++i) pipes.push_back(MakePipe(i));
  for (int i = model_.first_pump(); i < model_.first_valve(); ++i) pipes.push_back(MakePump(i));
  for (int i = model_.first_valve(); i < model_.link_count(); ++i) pipes.push_back(MakeValve(i));
  for (int i = model_.first_pump(); i < model_.link_count(); ++i) {
    const PipeEntry& link = At(pipes, i);
    const char* kind = i < model_.first_valve() ? "pump" : "valve";
    drawing.network.fittings.push_back({link.id, kind, link.id, 0.5 * *link.length_m});
  }
  AddNotes(drawing.notes);
  return drawing;
}

NodeEntry Drawer::MakeNode(int node) const {
  const Vector2d p_m = unit_m_ * (At(map_.nodes, node) - corner_);
  NodeEntry entry;
  entry.id = model_.NodeId(node);
  entry.position_m = {p_m.x(), p_m.y(), At(z_m_, node)};
  entry.open_water = node >= model_.junction_count();
  return entry;
}

PipeEntry Drawer::MakeEntry(int link, const std::string& id, double diameter_m) const {
  PipeEntry entry;
  entry.id = id;
  entry.from = model_.NodeId(model_.From(link));
  entry.to = model_.NodeId(model_.To(link));
  entry.diameter_m = diameter_m;
  entry.bend_radius_m = params_.bend_radius_diameters * diameter_m;
  entry.fit_bends = true;
  SetLine(link, entry);
  return entry;
}

/// Vertices, on a straight slope from end to end.
void Drawer::SetLine(int link, PipeEntry& entry) const {
  const std::vector<Vector2d>& line = At(map_.lines, link);
  const double from_m = At(z_m_, model_.From(link)), to_m = At(z_m_, model_.To(link));
  const double drawn = CalcDrawnLength(line);
  double along = 0;
  for (std::size_t i = 1; i + 1 < line.size(); ++i) {
    along += (line[i] - line[i - 1]).norm();
    const Vector2d p_m = unit_m_ * (line[i] - corner_);
    const double z = std::lerp(from_m, to_m, drawn > 0 ? along / drawn : 0);
    entry.vertices_m.insert(entry.vertices_m.end(), {p_m.x(), p_m.y(), z});
  }
}

void Drawer::SetWall(const PipeTraits& traits, PipeEntry& entry) const {
  const PipeWall wall = params_.materials.ChooseWall(traits);
  entry.material = wall.material;
  entry.wall_thickness_m = wall.thickness_m;
  entry.wall = FindWall(wall.material, {});
  if (traits.sand_roughness_m) entry.wall.roughness_m = *traits.sand_roughness_m;
}

double Drawer::CalcFittingLength_m(int link, double diameter_m) const {
  const double rise_m = std::abs(At(z_m_, model_.To(link)) - At(z_m_, model_.From(link)));
  return std::max(kLengthOverBore * diameter_m, kLengthOverRise * rise_m);
}

PipeEntry Drawer::MakePipe(int i) const {
  const sim::PipeLink& pipe = At(model_.pipes, i);
  PipeEntry entry = MakeEntry(i, pipe.id, pipe.diameter_m);
  entry.length_m = pipe.length_m;
  entry.passable = !IsClosed(pipe.status) && !pipe.check_valve;
  PipeTraits traits{pipe.tag, pipe.diameter_m, std::nullopt, std::nullopt};
  if (model_.options.law == sim::HeadLossLaw::kHazenWilliams) traits.hazen_williams = pipe.roughness;
  if (model_.options.law == sim::HeadLossLaw::kDarcyWeisbach) traits.sand_roughness_m = pipe.roughness;
  SetWall(traits, entry);
  return entry;
}

/// Bore of the narrowest pipe or valve at one of a pump's nodes, or anywhere when there is none.
double Drawer::FindNarrowestBeside_m(int pump) const {
  double beside_m = std::numeric_limits<double>::infinity(), anywhere_m = beside_m;
  const auto consider = [&](const auto& link) {
    anywhere_m = std::min(anywhere_m, link.diameter_m);
    for (const int node : {model_.From(pump), model_.To(pump)}) {
      if (link.from == node || link.to == node) beside_m = std::min(beside_m, link.diameter_m);
    }
  };
  for (const sim::PipeLink& pipe : model_.pipes) consider(pipe);
  for (const sim::ValveLink& valve : model_.valves) consider(valve);
  if (!std::isfinite(anywhere_m)) {
    throw InputError("there are only pumps, and nothing that says how wide they are", "network.inp",
                     model_.name);
  }
  return std::isfinite(beside_m) ? beside_m : anywhere_m;
}

PipeEntry Drawer::MakePump(int i) const {
  const sim::PumpLink& pump = At(model_.pumps, i - model_.first_pump());
  const double diameter_m = FindNarrowestBeside_m(i);
  PipeEntry entry = MakeEntry(i, pump.id, diameter_m);
  entry.length_m = CalcFittingLength_m(i, diameter_m);
  entry.passable = false;
  SetWall({pump.tag, diameter_m, std::nullopt, std::nullopt}, entry);
  return entry;
}

PipeEntry Drawer::MakeValve(int i) const {
  const sim::ValveLink& valve = At(model_.valves, i - model_.first_valve());
  PipeEntry entry = MakeEntry(i, valve.id, valve.diameter_m);
  entry.length_m = CalcFittingLength_m(i, valve.diameter_m);
  const bool fixed = valve.status != sim::LinkStatus::kActive;
  const double setting = fixed ? std::numeric_limits<double>::quiet_NaN() : valve.setting;
  entry.passable = sim::IsWideOpen(valve.kind, valve.status, setting, valve.minor_loss);
  SetWall({valve.tag, valve.diameter_m, std::nullopt, std::nullopt}, entry);
  return entry;
}

void Drawer::AddNotes(std::vector<std::string>& notes) const {
  const auto check_valves = std::count_if(model_.pipes.begin(), model_.pipes.end(),
                                          [](const sim::PipeLink& pipe) { return pipe.check_valve; });
  if (check_valves > 0) {
    notes.push_back("check valves: the flaps of " + std::to_string(check_valves) + " let no ball pass");
  }
  if (model_.reservoir_count() > 0) {
    notes.push_back("reservoirs: pipes of " + std::to_string(model_.reservoir_count()) +
                    " are laid at the lowest neighbour's elevation; the file tells the water level only");
  }
}

}  // namespace

InpDrawing DrawNetwork(const HydraulicModel& model, const DrawingParams& params) {
  RequireCoordinates(model);
  return Drawer(model, params).Draw();
}

}  // namespace piperun::scenarios
