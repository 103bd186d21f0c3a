// Balls that the water carries: published speeds, and which way they must change.

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "base/number.h"
#include "base/water.h"
#include "scenarios/assemble.h"
#include "scenarios/load.h"
#include "scenarios/physics/groups.h"

namespace piperun::scenarios::physics {
namespace {

/// A straight pipe, rising with a slope, with water of 15 C in it.
struct CarriedCase {
  double bore_m = 0.03175;
  double diameter_ratio = 0.6;
  double relative_density = 1.2;
  double water_speed_m_s = 1.2;
  double slope_rad = 0;
  double length_m = 40;
};

Scenario MakeScenario(const CarriedCase& c) {
  const std::string end = "[" + FormatNumber(c.length_m * std::cos(c.slope_rad)) + ", 0, " +
                          FormatNumber(c.length_m * std::sin(c.slope_rad)) + "]";
  const double flow_m3_s = c.water_speed_m_s * std::numbers::pi / 4 * c.bore_m * c.bore_m;
  const double density = c.relative_density * CalcWater(15).density_kg_m3;
  return ParseScenario(
      "schema: piperun.scenario/1\nname: carried\nwater: {temperature_C: 15}\nnetwork:\n  nodes:\n"
      "    - {id: A, position_m: [0, 0, 0]}\n    - {id: B, position_m: " +
          end + "}\n  pipes:\n    - {id: P, from: A, to: B, diameter_m: " + FormatNumber(c.bore_m) +
          ", wall_thickness_m: 0.003, material: pvc_u}\nflow: {inlet_m3_s: " + FormatNumber(flow_m3_s) +
          ", inlet_pressure_Pa: 1e7}\nball: {radius_m: " + FormatNumber(0.5 * c.diameter_ratio * c.bore_m) +
          ", density_kg_m3: " + FormatNumber(density) +
          ", friction: 0.5}\nmission: {launch: A, retrieve: B, stuck_after_s: 20}\n",
      "carried");
}

/// Speed just before the end, over the water's; 0 when the ball does not get there.
double CalcSpeedRatio(const CarriedCase& c) {
  const auto assembly = Assemble(MakeScenario(c));
  sim::Motion& motion = *assembly->motion;
  while (motion.status() == sim::MotionStatus::kRunning && motion.state().chainage_m < c.length_m - 0.2) {
    motion.Step();
  }
  return motion.status() == sim::MotionStatus::kRunning ? motion.state().v_WB_W.norm() / c.water_speed_m_s
                                                        : 0;
}

void CheckEllis(FigureChecks& checks) {
  ReproducedTable table{
      "Ball speed over water speed in a level pipe of 31.75 mm, relative density 1.2, 1.2 m/s",
      {"d/D", "v/U", "Ellis 1964"},
      {}};
  for (const double ratio : {0.6, 0.7, 0.8}) {
    const double speed = CalcSpeedRatio({.diameter_ratio = ratio});
    table.rows.push_back({FormatNumber(ratio), FormatFixed(speed, 3), "1.04 to 1.08"});
    checks.Between("v/U at d/D = " + FormatNumber(ratio), speed, 1.04 - 0.01, 1.08 + 0.01,
                   "Ellis 1964 (abstract), which k_spin is calibrated on");
  }
  checks.report().tables.push_back(std::move(table));
}

/// Whether values rise or fall all the way.
bool Rises(const std::vector<double>& values) {
  return std::is_sorted(values.begin(), values.end(), std::less_equal<>());
}

void CheckTrends(FigureChecks& checks) {
  const auto sweep = [](const std::array<double, 3>& values, double CarriedCase::*field) {
    std::vector<double> ratios;
    for (const double value : values) {
      CarriedCase c;
      c.*field = value;
      ratios.push_back(CalcSpeedRatio(c));
    }
    return ratios;
  };
  const auto note = [&](const std::string& what, const std::vector<double>& ratios, bool as_expected,
                        const std::string& expected) {
    checks.report().figures.push_back(
        {"carried: " + what,
         FormatFixed(ratios[0], 3) + ", " + FormatFixed(ratios[1], 3) + ", " + FormatFixed(ratios[2], 3),
         expected, as_expected, "force balance"});
  };
  const auto by_density = sweep({1.05, 1.3, 2.0}, &CarriedCase::relative_density);
  note("v/U at relative density 1.05, 1.3, 2", by_density, Rises({by_density.rbegin(), by_density.rend()}),
       "falls: more rolling resistance");
  const auto by_speed = sweep({0.4, 0.8, 1.6}, &CarriedCase::water_speed_m_s);
  note("v/U at 0.4, 0.8, 1.6 m/s", by_speed, Rises(by_speed), "rises: drag outgrows resistance");
  const auto by_size = sweep({0.3, 0.5, 0.7}, &CarriedCase::diameter_ratio);
  note("v/U at d/D 0.3, 0.5, 0.7", by_size, Rises(by_size), "rises: reaches into faster water");
}

/// The reference ball in a riser: the water must reach its terminal speed where it is, between the axis (1.17
/// U for d/D = 0.4) and the wall (1.03 U).
void CheckRiser(FigureChecks& checks) {
  CarriedCase riser{0.15, 0.4, 1.1, 0, std::numbers::pi / 2, 5};
  const double terminal_m_s = 0.34;
  riser.water_speed_m_s = 0.9 * terminal_m_s / 1.17;
  checks.Near("speed of a ball in a riser, water 10 % slower than holds it on the axis",
              CalcSpeedRatio(riser), 0, 0, "drag < weight: it stays below");
  riser.water_speed_m_s = 1.1 * terminal_m_s / 1.03;
  checks.AtLeast("the same over the water's, 10 % faster than holds it at the wall", CalcSpeedRatio(riser),
                 0.05, "drag > weight: it rises");
}

}  // namespace

void CheckCarried(const ReproduceOptions&, ReproduceReport& report) {
  FigureChecks checks(report, "carried");
  CheckEllis(checks);
  CheckTrends(checks);
  CheckRiser(checks);
}

}  // namespace piperun::scenarios::physics
