#include <cmath>
#include <vector>

#include "sim/network/epanet_constants.h"
#include "sim/network/inp_draft.h"

namespace piperun::sim {
namespace {

/// The first line of a junction replaces its demand of [JUNCTIONS], the others add to it.
void ReadDemands(const InpSections& sections, InpDraft& draft) {
  std::vector<bool> replaced(draft.model.junctions.size());
  for (const InpLine& line : Lines(sections, InpSection::kDemands)) {
    line.RequireWords(2, "junction demand (pattern)");
    const int node = ReadNode(line, 0, draft);
    if (!draft.IsJunction(node))
      line.Fail("'" + line[0] + "' is not a junction; only junctions have demands");
    DemandCategory demand{draft.units.flow_m3_s * ReadNumber(line, 1, "demand"), draft.default_pattern,
                          line.comment};
    if (line.size() > 2) demand.pattern = ReadPattern(line, 2, draft);
    auto& demands = draft.model.junctions[node].demands;
    if (!replaced[node]) demands.clear();
    replaced[node] = true;
    demands.push_back(std::move(demand));
  }
}

/// q = C p^n in units of the file, turned into q = C' h^n in SI.
void ReadEmitters(const InpSections& sections, InpDraft& draft) {
  const double unit =
      draft.units.flow_m3_s / std::pow(draft.units.emitter_pressure_m, draft.model.options.emitter_exponent);
  for (const InpLine& line : Lines(sections, InpSection::kEmitters)) {
    const int node = ReadNode(line, 0, draft);
    if (!draft.IsJunction(node))
      line.Fail("'" + line[0] + "' is not a junction; only junctions have emitters");
    draft.model.junctions[node].emitter =
        unit * ReadNumber(line, 1, "emitter coefficient", Range::NonNegative());
  }
}

/// Crack area [mm2] and its growth with pressure head [mm2/m], both per 100 length units of the file.
void ReadLeakage(const InpSections& sections, InpDraft& draft) {
  for (const InpLine& line : Lines(sections, InpSection::kLeakage)) {
    line.RequireWords(3, "pipe area expansion");
    PipeLink* pipe = draft.FindPipe(ReadLink(line, 0, draft));
    if (pipe == nullptr) line.Fail("'" + line[0] + "' is not a pipe; only pipes leak");
    const double hundreds = pipe->length_m / (100 * draft.units.length_m);
    const double square_mm = 1e-6 * hundreds * epanet::kOrifice_m05_s;
    pipe->leakage.fixed_m25_s = square_mm * ReadNumber(line, 1, "leak area", Range::NonNegative());
    pipe->leakage.variable_m15_s = square_mm * ReadNumber(line, 2, "leak expansion", Range::NonNegative());
  }
}

}  // namespace

void ReadOutflows(const InpSections& sections, InpDraft& draft) {
  ReadDemands(sections, draft);
  ReadEmitters(sections, draft);
  ReadLeakage(sections, draft);
}

}  // namespace piperun::sim
