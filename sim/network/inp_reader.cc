#include "sim/network/inp_reader.h"

#include <utility>

#include "base/check.h"
#include "sim/network/inp_draft.h"

namespace piperun::sim {

void RefuseSize(std::uintmax_t bytes, std::string_view name) {
  throw InputError("the file has " + std::to_string(bytes >> 20) + " MiB; an EPANET input file has at most " +
                       std::to_string(kMaxInpBytes >> 20),
                   {}, std::string(name));
}

HydraulicModel ReadInp(std::string_view text, std::string_view name) {
  if (text.size() > kMaxInpBytes) RefuseSize(text.size(), name);
  const InpSections sections = SplitInp(text, name);
  InpDraft draft;
  draft.model.name = name;
  for (const InpLine& line : Lines(sections, InpSection::kTitle)) draft.model.title.push_back(line[0]);
  ReadOptions(sections, draft);
  ReadTimes(sections, draft);
  ReadPatternsAndCurves(sections, draft);
  ReadNodes(sections, draft);
  ReadLinks(sections, draft);
  ReadOutflows(sections, draft);
  ReadControls(sections, draft);
  ReadRules(sections, draft);
  ReadMap(sections, draft);
  NoteWhatIsIgnored(sections, draft);
  RequireConnected(sections, draft);
  return std::move(draft.model);
}

}  // namespace piperun::sim
