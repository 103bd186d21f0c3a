#include <string>

#include "sim/network/inp_draft.h"

namespace piperun::sim {
namespace {

void AddIndex(const InpLine& line, InpDraft& draft, int index) {
  if (!draft.node_index.try_emplace(line[0], index).second) {
    line.Fail("the node id '" + line[0] + "' is used twice; give every node an id of its own");
  }
}

bool HasWord(const InpLine& line, std::size_t i) { return i < line.size() && line[i] != "*"; }

void ReadJunction(const InpLine& line, InpDraft& draft) {
  JunctionNode junction;
  junction.id = line[0];
  if (line.size() > 1) junction.elevation_m = draft.units.length_m * ReadNumber(line, 1, "elevation");
  DemandCategory demand{0, draft.default_pattern, {}};
  if (line.size() > 2) demand.base_m3_s = draft.units.flow_m3_s * ReadNumber(line, 2, "demand");
  if (HasWord(line, 3)) demand.pattern = ReadPattern(line, 3, draft);
  junction.demands.push_back(demand);
  AddIndex(line, draft, draft.model.junction_count());
  draft.model.junctions.push_back(std::move(junction));
}

void ReadReservoir(const InpLine& line, InpDraft& draft) {
  line.RequireWords(2, "id head (pattern)");
  ReservoirNode reservoir;
  reservoir.id = line[0];
  reservoir.head_m = draft.units.length_m * ReadNumber(line, 1, "head");
  if (HasWord(line, 2)) reservoir.pattern = ReadPattern(line, 2, draft);
  AddIndex(line, draft, draft.model.first_tank());
  draft.model.reservoirs.push_back(std::move(reservoir));
}

void RequireLevels(const InpLine& line, const TankNode& tank) {
  if (!(tank.min_level_m <= tank.initial_level_m && tank.initial_level_m <= tank.max_level_m)) {
    line.Fail("the tank's levels do not agree: initial " + line[2] + ", minimum " + line[3] + ", maximum " +
              line[4] + "; minimum <= initial <= maximum must hold");
  }
  const Curve& curve = tank.volume_curve;
  if (curve.empty()) return;
  for (std::size_t i = 1; i < curve.size(); ++i) {
    if (curve[i].y <= curve[i - 1].y)
      line.Fail("the volumes of curve '" + line[7] + "' must rise with the level");
  }
  const double slack = 1e-6 * (curve.back().x - curve.front().x);
  if (curve.size() < 2 || tank.min_level_m < curve.front().x - slack ||
      tank.max_level_m > curve.back().x + slack) {
    line.Fail("the volume curve '" + line[7] + "' does not reach from the tank's minimum level " + line[3] +
              " to its maximum level " + line[4]);
  }
}

void ReadTank(const InpLine& line, InpDraft& draft) {
  line.RequireWords(6, "id elevation initial minimum maximum diameter (minimum-volume) (curve) (overflow)");
  const double length = draft.units.length_m;
  TankNode tank;
  tank.id = line[0];
  tank.elevation_m = length * ReadNumber(line, 1, "elevation");
  tank.initial_level_m = length * ReadNumber(line, 2, "initial level", Range::NonNegative());
  tank.min_level_m = length * ReadNumber(line, 3, "minimum level", Range::NonNegative());
  tank.max_level_m = length * ReadNumber(line, 4, "maximum level", Range::NonNegative());
  tank.diameter_m = length * ReadNumber(line, 5, "diameter", Range::NonNegative());
  if (HasWord(line, 6)) {
    tank.min_volume_m3 =
        draft.units.volume_m3() * ReadNumber(line, 6, "minimum volume", Range::NonNegative());
  }
  if (HasWord(line, 7)) tank.volume_curve = ReadCurve(line, 7, draft, length, draft.units.volume_m3());
  if (line.size() > 8) {
    tank.can_overflow = BeginsWith(line[8], "YES");
    if (!tank.can_overflow && !BeginsWith(line[8], "NO"))
      line.Fail("the overflow is '" + line[8] + "'; allowed: YES, NO");
  }
  if (tank.volume_curve.empty() && tank.diameter_m == 0) {
    line.Fail("the tank's diameter is 0; it must be > 0, or a volume curve must be given");
  }
  RequireLevels(line, tank);
  AddIndex(line, draft, draft.model.node_count());
  draft.model.tanks.push_back(std::move(tank));
}

}  // namespace

void ReadNodes(const InpSections& sections, InpDraft& draft) {
  const auto& tanks = Lines(sections, InpSection::kTanks);
  const auto is_reservoir = [](const InpLine& line) { return line.size() <= 3; };
  for (const InpLine& line : Lines(sections, InpSection::kJunctions)) ReadJunction(line, draft);
  for (const InpLine& line : Lines(sections, InpSection::kReservoirs)) {
    if (is_reservoir(line)) ReadReservoir(line, draft);
  }
  for (const InpLine& line : tanks) {
    if (is_reservoir(line)) ReadReservoir(line, draft);  // EPANET allows either under either heading
  }
  for (const InpLine& line : Lines(sections, InpSection::kReservoirs)) {
    if (!is_reservoir(line)) ReadTank(line, draft);
  }
  for (const InpLine& line : tanks) {
    if (!is_reservoir(line)) ReadTank(line, draft);
  }
}

}  // namespace piperun::sim
