#include "sim/network/inp_draft.h"

namespace piperun::sim {
namespace {

MapPoint ReadPoint(const InpLine& line) {
  line.RequireWords(3, "id x y");
  return {ReadNumber(line, 1, "x"), ReadNumber(line, 2, "y")};
}

/// Calls `act` with the node or link of a number, whatever it is.
template <class Act>
void WithNode(InpDraft& draft, int node, Act act) {
  HydraulicModel& model = draft.model;
  if (draft.IsJunction(node)) return act(model.junctions[node]);
  if (draft.IsTank(node)) return act(model.tanks[node - model.first_tank()]);
  act(model.reservoirs[node - model.junction_count()]);
}

template <class Act>
void WithLink(InpDraft& draft, int link, Act act) {
  if (PipeLink* pipe = draft.FindPipe(link)) return act(*pipe);
  if (PumpLink* pump = draft.FindPump(link)) return act(*pump);
  act(*draft.FindValve(link));
}

void ReadTag(const InpLine& line, InpDraft& draft) {
  line.RequireWords(3, "NODE|LINK id tag");
  const auto set_tag = [&](auto& element) { element.tag = line[2]; };
  if (BeginsWith(line[0], "NODE")) return WithNode(draft, ReadNode(line, 1, draft), set_tag);
  if (BeginsWith(line[0], "LINK")) return WithLink(draft, ReadLink(line, 1, draft), set_tag);
  line.Fail("'" + line[0] + "' must be NODE or LINK");
}

}  // namespace

void ReadMap(const InpSections& sections, InpDraft& draft) {
  int unknown = 0;
  for (const InpLine& line : Lines(sections, InpSection::kCoordinates)) {
    const MapPoint point = ReadPoint(line);
    const auto node = draft.node_index.find(line[0]);
    if (node == draft.node_index.end()) {
      ++unknown;
    } else {
      WithNode(draft, node->second, [&](auto& element) { element.position = point; });
    }
  }
  for (const InpLine& line : Lines(sections, InpSection::kVertices)) {
    const MapPoint point = ReadPoint(line);
    const auto link = draft.link_index.find(line[0]);
    if (link == draft.link_index.end()) {
      ++unknown;
    } else {
      WithLink(draft, link->second, [&](auto& element) { element.vertices.push_back(point); });
    }
  }
  if (unknown > 0) {
    draft.model.notes.push_back("[COORDINATES], [VERTICES]: " + std::to_string(unknown) +
                                " lines of unknown nodes or links left out");
  }
  for (const InpLine& line : Lines(sections, InpSection::kTags)) ReadTag(line, draft);
}

void NoteWhatIsIgnored(const InpSections& sections, InpDraft& draft) {
  struct Ignored {
    InpSection section;
    const char* why;
  };
  constexpr Ignored kIgnored[] = {{InpSection::kEnergy, "pumping energy and its price are not computed"},
                                  {InpSection::kQuality, "water quality is not simulated"},
                                  {InpSection::kSources, "water quality is not simulated"},
                                  {InpSection::kReactions, "water quality is not simulated"},
                                  {InpSection::kMixing, "water quality is not simulated"},
                                  {InpSection::kReport, "every node and link is reported"},
                                  {InpSection::kLabels, "labels of the drawing are not used"},
                                  {InpSection::kBackdrop, "the drawing's backdrop is not used"},
                                  {InpSection::kRoughness, "EPANET itself no longer reads this section"}};
  if (!sections.has_end) draft.model.notes.push_back("no [END]: the file may be cut short");
  for (const Ignored& ignored : kIgnored) {
    const std::size_t count = Lines(sections, ignored.section).size();
    if (count == 0) continue;
    draft.model.notes.push_back(std::string(SectionName(ignored.section)) + ": " + std::to_string(count) +
                                (count == 1 ? " line" : " lines") + " not read, " + ignored.why);
  }
}

}  // namespace piperun::sim
