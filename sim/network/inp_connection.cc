#include <vector>

#include "base/check.h"
#include "sim/network/inp_draft.h"

namespace piperun::sim {
namespace {

/// Every node that hangs on a reservoir or tank, by whatever links, open or closed.
std::vector<bool> FindConnected(const HydraulicModel& model) {
  std::vector<std::vector<int>> neighbours(model.node_count());
  for (int link = 0; link < model.link_count(); ++link) {
    neighbours[model.From(link)].push_back(model.To(link));
    neighbours[model.To(link)].push_back(model.From(link));
  }
  std::vector<bool> connected(model.node_count());
  std::vector<int> open;
  for (int node = model.junction_count(); node < model.node_count(); ++node) open.push_back(node);
  while (!open.empty()) {
    const int node = open.back();
    open.pop_back();
    if (connected[node]) continue;
    connected[node] = true;
    open.insert(open.end(), neighbours[node].begin(), neighbours[node].end());
  }
  return connected;
}

}  // namespace

void RequireConnected(const InpSections& sections, const InpDraft& draft) {
  const HydraulicModel& model = draft.model;
  const auto& lines = Lines(sections, InpSection::kJunctions);
  if (lines.empty())
    throw InputError("the network has no junction; the file may be cut short", "[JUNCTIONS]", model.name);
  if (model.node_count() == model.junction_count()) {
    throw InputError("the network has no reservoir and no tank, so no head is given; add one", "[RESERVOIRS]",
                     model.name);
  }
  const std::vector<bool> connected = FindConnected(model);
  for (int i = 0; i < model.junction_count(); ++i) {
    if (!connected[i]) {
      lines[i].Fail(
          "no pipe, pump or valve leads from the junction to a reservoir or tank; connect it or remove it");
    }
  }
}

}  // namespace piperun::sim
