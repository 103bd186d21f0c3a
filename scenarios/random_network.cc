#include "scenarios/random_network.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>
#include <vector>

#include "base/number.h"
#include "base/random.h"
#include "scenarios/load.h"

namespace piperun::scenarios {
namespace {

using std::numbers::pi;

constexpr double kFeedLength_m = 2;
constexpr double kPressureHead_m = 30;
constexpr double kFastest_m_s = 1.5;
constexpr double kMinAngle_rad = 35 * pi / 180;

/// Draws one number after the other.
class Dice {
 public:
  Dice(std::uint64_t seed, std::uint64_t index) : random_(seed, "random_network", index) {}
  double Uniform() {
    const std::uint64_t i = next_++;
    return random_.Uniforms(i / 4, 0)[i % 4];
  }
  double Between(double low, double high) { return low + (high - low) * Uniform(); }
  std::size_t Below(std::size_t n) {
    return std::min(n - 1, static_cast<std::size_t>(Uniform() * static_cast<double>(n)));
  }
  bool Chance(double p) { return Uniform() < p; }

 private:
  RandomStream random_;
  std::uint64_t next_ = 0;
};

struct Knot {
  Vector3d p_W = Vector3d::Zero();
  std::vector<Vector3d> ways;  // unit, into its pipes
  double demand_m3_s = 0;
};

struct Tube {
  std::size_t from = 0, to = 0;
  double diameter_m = 0;
  std::vector<Vector3d> vertices;
};

struct Plan {
  std::vector<Knot> knots;  // 0: the feed, 1: the launch
  std::vector<Tube> tubes;
};

bool HasRoom(const Knot& knot, const Vector3d& way) {
  return std::none_of(knot.ways.begin(), knot.ways.end(),
                      [&](const Vector3d& other) { return way.dot(other) > std::cos(kMinAngle_rad); });
}

Vector3d DrawWay(Dice& dice) {
  if (dice.Chance(0.2)) return {0, 0, dice.Chance(0.5) ? 1.0 : -1.0};
  const double azimuth = dice.Between(0, 2 * pi), slope = dice.Chance(0.5) ? 0 : dice.Between(-0.5, 0.5);
  return {std::cos(slope) * std::cos(azimuth), std::cos(slope) * std::sin(azimuth), std::sin(slope)};
}

double DrawBore(Dice& dice) {
  constexpr double kBores_m[] = {0.052, 0.08, 0.1, 0.1, 0.125, 0.15, 0.15, 0.2};
  return kBores_m[dice.Below(std::size(kBores_m))];
}

void AddTube(std::size_t from, const Vector3d& way, double length_m, double diameter_m, Plan& plan) {
  plan.knots[from].ways.push_back(way);
  plan.knots.push_back({plan.knots[from].p_W + length_m * way, {-way}, 0});
  plan.tubes.push_back({from, plan.knots.size() - 1, diameter_m, {}});
}

/// A corner half-way, drawn aside by up to a third of the length; level pipes only.
void AddCorner(Dice& dice, Plan& plan) {
  Tube& tube = plan.tubes.back();
  const Vector3d a = plan.knots[tube.from].p_W, b = plan.knots[tube.to].p_W, d = b - a;
  if (std::abs(d.z()) > 0.1 * d.norm()) return;
  tube.vertices = {0.5 * (a + b) + dice.Between(-0.15, 0.15) * Vector3d(-d.y(), d.x(), 0)};
}

/// A pipe between two ends, where there is room for it.
void CloseLoop(Dice& dice, Plan& plan) {
  const std::size_t a = 2 + dice.Below(plan.knots.size() - 2), b = 2 + dice.Below(plan.knots.size() - 2);
  const Vector3d d = plan.knots[b].p_W - plan.knots[a].p_W;
  if (a == b || d.norm() < 0.8) return;
  const Vector3d way = d.normalized();
  if (!HasRoom(plan.knots[a], way) || !HasRoom(plan.knots[b], -way)) return;
  plan.knots[a].ways.push_back(way);
  plan.knots[b].ways.push_back(-way);
  plan.tubes.push_back({a, b, DrawBore(dice), {}});
}

Plan DrawPlan(Dice& dice, double first_bore_m) {
  Plan plan;
  plan.knots.push_back({{-kFeedLength_m, 0, 0}, {}, 0});
  AddTube(0, Vector3d::UnitX(), kFeedLength_m, first_bore_m, plan);
  AddTube(1, Vector3d::UnitX(), dice.Between(1, 4), first_bore_m, plan);
  const std::size_t wanted = 5 + dice.Below(6);
  for (int tries = 0; plan.tubes.size() < wanted && tries < 100; ++tries) {
    const std::size_t from = 2 + dice.Below(plan.knots.size() - 2);
    const Vector3d way = DrawWay(dice);
    if (!HasRoom(plan.knots[from], way)) continue;
    AddTube(from, way, dice.Between(1, 5), DrawBore(dice), plan);
    if (dice.Chance(0.25)) AddCorner(dice, plan);
  }
  if (dice.Chance(0.3)) CloseLoop(dice, plan);
  return plan;
}

/// Bore of the narrowest pipe between the launch and every knot.
std::vector<double> FindNarrowest(const Plan& plan) {
  std::vector<double> narrowest_m(plan.knots.size(), 1);
  for (const Tube& tube :
       plan.tubes) {  // pipes come after those that lead to them; a loop's last adds nothing
    const double bore_m = std::min(narrowest_m[tube.from], tube.diameter_m);
    if (narrowest_m[tube.to] == 1) narrowest_m[tube.to] = bore_m;
  }
  return narrowest_m;
}

/// Half of the ends draw water, at least one does, and none faster than kFastest_m_s through any pipe on the
/// way; the first pipe carries `flow_m3_s` or as much of it as that leaves.
void DrawDemands(Dice& dice, double flow_m3_s, Plan& plan) {
  const std::vector<double> narrowest_m = FindNarrowest(plan);
  double sum_m3_s = 0;
  for (std::size_t i = 2; i < plan.knots.size(); ++i) {
    Knot& knot = plan.knots[i];
    const bool is_end = knot.ways.size() == 1, is_last = i + 1 == plan.knots.size();
    const bool draws = (is_end && dice.Chance(0.5)) || (is_last && sum_m3_s == 0);
    if (!draws) continue;
    knot.demand_m3_s = dice.Between(0.2, 1) * kFastest_m_s * pi / 4 * narrowest_m[i] * narrowest_m[i];
    sum_m3_s += knot.demand_m3_s;
  }
  // ends share pipes: all together through the first one's bore is the most that any pipe may see
  for (Knot& knot : plan.knots) knot.demand_m3_s *= std::min(1.0, flow_m3_s / sum_m3_s);
}

std::string Point(double x, double y) { return FormatNumber(x) + " " + FormatNumber(y); }

double Length_m(const Plan& plan, const Tube& tube) {
  double length_m = 0;
  Vector3d at = plan.knots[tube.from].p_W;
  for (const Vector3d& vertex : tube.vertices) {
    length_m += (vertex - at).norm();
    at = vertex;
  }
  return length_m + (plan.knots[tube.to].p_W - at).norm();
}

/// As an EPANET file: the feed is a reservoir, knots N1, N2, ..., pipes P0, P1, ...
std::string WriteInp(const Plan& plan) {
  std::ostringstream inp;
  const auto name = [](std::size_t knot) { return knot == 0 ? "FEED" : "N" + std::to_string(knot); };
  inp << "[JUNCTIONS]\n";
  for (std::size_t i = 1; i < plan.knots.size(); ++i) {
    inp << name(i) << ' ' << Point(plan.knots[i].p_W.z(), 1000 * plan.knots[i].demand_m3_s) << '\n';
  }
  inp << "[RESERVOIRS]\nFEED " << FormatNumber(kPressureHead_m) << "\n[PIPES]\n";
  for (std::size_t i = 0; i < plan.tubes.size(); ++i) {
    const Tube& tube = plan.tubes[i];
    inp << 'P' << i << ' ' << name(tube.from) << ' ' << name(tube.to) << ' '
        << Point(Length_m(plan, tube), 1000 * tube.diameter_m) << " 0.01 0 Open\n";
  }
  inp << "[OPTIONS]\nUnits LPS\nHeadloss D-W\n[COORDINATES]\n";
  for (std::size_t i = 0; i < plan.knots.size(); ++i) {
    inp << name(i) << ' ' << Point(plan.knots[i].p_W.x(), plan.knots[i].p_W.y()) << '\n';
  }
  inp << "[VERTICES]\n";
  for (std::size_t i = 0; i < plan.tubes.size(); ++i) {
    for (const Vector3d& v : plan.tubes[i].vertices) inp << 'P' << i << ' ' << Point(v.x(), v.y()) << '\n';
  }
  inp << "[END]\n";
  return inp.str();
}

Scenario MakeScenario(std::string inp) {
  Scenario scenario;
  scenario.name = "random_network";
  scenario.network.inp = "generated";
  scenario.network.inp_text = std::move(inp);
  scenario.network.map_unit_m = 1;
  scenario.mission.launch = "N1";
  scenario.mission.time_limit_s = 60;
  scenario.mission.stuck_after_s = 10;
  return scenario;
}

}  // namespace

Scenario MakeRandomNetwork(std::uint64_t seed, std::uint64_t index) {
  Dice dice(seed, index);
  const double bore_m = dice.Chance(0.5) ? 0.15 : 0.1;
  Plan plan = DrawPlan(dice, bore_m);
  DrawDemands(dice, dice.Between(0.2, 1.5) * pi / 4 * bore_m * bore_m, plan);
  Scenario scenario = MakeScenario(WriteInp(plan));
  scenario.seed = static_cast<std::int64_t>(seed);
  scenario.run = static_cast<std::int64_t>(index);
  scenario.ball.radius_m = dice.Between(0.015, 0.035);
  scenario.ball.density_kg_m3 = dice.Between(970, 1330);
  scenario.mission.lateral_sd_m = 0.03;
  return scenario;
}

Scenario MakeBranching(double straight_deg, double branch_deg, double share, double speed_m_s) {
  constexpr double kBore_m = 0.15;
  const double flow_m3_s = speed_m_s * pi / 4 * kBore_m * kBore_m;
  const auto way = [](double degrees) {
    return Vector3d(std::cos(degrees * pi / 180), std::sin(degrees * pi / 180), 0);
  };
  Plan plan;
  plan.knots.push_back({{-kFeedLength_m, 0, 0}, {}, 0});
  AddTube(0, Vector3d::UnitX(), kFeedLength_m, kBore_m, plan);
  AddTube(1, Vector3d::UnitX(), 4, kBore_m, plan);
  AddTube(2, way(straight_deg), 3, kBore_m, plan);
  AddTube(2, way(branch_deg), 3, kBore_m, plan);
  plan.knots[3].demand_m3_s = (1 - share) * flow_m3_s;
  plan.knots[4].demand_m3_s = share * flow_m3_s;
  Scenario scenario = MakeScenario(WriteInp(plan));
  scenario.mission.lateral_sd_m = 0.02;
  return scenario;
}

}  // namespace piperun::scenarios
