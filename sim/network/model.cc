#include "sim/network/model.h"

namespace piperun::sim {

const char* StatusText(LinkStatus status) {
  if (IsClosed(status)) return "closed";
  return status == LinkStatus::kActive ? "active" : "open";
}

namespace {

/// Calls `visit` with the junction, reservoir or tank of a number.
template <class Visit>
decltype(auto) VisitNode(const HydraulicModel& model, int node, Visit visit) {
  if (node < model.junction_count()) return visit(model.junctions[node]);
  if (node < model.first_tank()) return visit(model.reservoirs[node - model.junction_count()]);
  return visit(model.tanks[node - model.first_tank()]);
}

template <class Visit>
decltype(auto) VisitLink(const HydraulicModel& model, int link, Visit visit) {
  if (link < model.first_pump()) return visit(model.pipes[link]);
  if (link < model.first_valve()) return visit(model.pumps[link - model.first_pump()]);
  return visit(model.valves[link - model.first_valve()]);
}

double ZeroLevel(const JunctionNode& junction) { return junction.elevation_m; }
double ZeroLevel(const ReservoirNode& reservoir) { return reservoir.head_m; }
double ZeroLevel(const TankNode& tank) { return tank.elevation_m; }

}  // namespace

const std::string& HydraulicModel::NodeId(int node) const {
  return VisitNode(*this, node, [](const auto& n) -> const std::string& { return n.id; });
}

const std::string& HydraulicModel::LinkId(int link) const {
  return VisitLink(*this, link, [](const auto& l) -> const std::string& { return l.id; });
}

double HydraulicModel::Elevation_m(int node) const {
  return VisitNode(*this, node, [](const auto& n) { return ZeroLevel(n); });
}

int HydraulicModel::From(int link) const {
  return VisitLink(*this, link, [](const auto& l) { return l.from; });
}

int HydraulicModel::To(int link) const {
  return VisitLink(*this, link, [](const auto& l) { return l.to; });
}

}  // namespace piperun::sim
