// Drag and wall correlations against tables that others computed.

#include <array>
#include <cmath>

#include "base/number.h"
#include "scenarios/physics/groups.h"
#include "sim/drag.h"
#include "sim/wall_factor.h"

namespace piperun::scenarios::physics {
namespace {

/// C_D at one Reynolds number; 0: beyond the law.
struct DragRow {
  double reynolds;
  std::array<double, 5> drag;
};
constexpr std::array<const char*, 5> kDragKeys{"clift_grace_weber", "clift_gauvin", "brown_lawler",
                                               "morrison", "barati_high"};
constexpr std::array kDragTable{DragRow{10, {4.2584, 4.1347, 4.1275, 3.9676, 4.3638}},
                                DragRow{100, {1.0870, 1.0704, 1.0731, 1.0382, 1.0737}},
                                DragRow{1e3, {0.4711, 0.4639, 0.4634, 0.4841, 0.4649}},
                                DragRow{1e4, {0.4052, 0.4103, 0.4106, 0.3936, 0.4109}},
                                DragRow{1e5, {0.5018, 0.4675, 0.4661, 0.4247, 0.4670}},
                                DragRow{2e5, {0.4977, 0.4670, 0.4635, 0.4120, 0.4730}},
                                DragRow{3e5, {0.4808, 0.4647, 0.4600, 0.1680, 0.1796}},
                                DragRow{4e5, {0.0702, 0, 0, 0.0874, 0.0901}},
                                DragRow{1e6, {0.1100, 0, 0, 0.1415, 0.2125}}};

void CheckDragTable(FigureChecks& checks) {
  for (std::size_t law = 0; law < kDragKeys.size(); ++law) {
    double largest = 0;
    for (const DragRow& row : kDragTable) {
      if (row.drag[law] == 0) continue;
      const double drag = sim::CalcDragCoefficient(sim::FindDragLaw(kDragKeys[law]).law, row.reynolds);
      largest = std::fmax(largest, std::abs(drag - row.drag[law]));
    }
    checks.AtMost(std::string(kDragKeys[law]) + ": error of C_D, Re 10 to 1e6", largest, 1e-4,
                  "independent implementation, four decimals");
  }
}

/// Largest relative change of C_D over a relative step of Re that no smooth law could make jump.
double CalcLargestJump(sim::DragLaw law) {
  constexpr double kStep = 1 + 1e-5;
  double largest = 0, before = 0;
  for (double reynolds = 1e-2; reynolds < 1e6; reynolds *= kStep) {
    const double drag = sim::CalcDragCoefficient(law, reynolds);
    if (before > 0) largest = std::fmax(largest, std::abs(drag / before - 1));
    before = drag;
  }
  return largest;
}

void CheckJumps(FigureChecks& checks) {
  for (const char* key : {"clift_grace_weber", "clift_gauvin", "clift_gauvin_1970", "brown_lawler",
                          "morrison", "barati_high"}) {
    checks.AtMost(std::string(key) + ": largest jump of C_D, Re 1e-2 to 1e6",
                  CalcLargestJump(sim::FindDragLaw(key).law), 0.005, "a drag law has none");
  }
}

void CheckWallFactors(FigureChecks& checks) {
  // at high Re: Newton, Munroe, Di Felice, Kehlenbeck & Di Felice
  struct Row {
    double diameter_ratio;
    std::array<double, 4> factor;
  };
  constexpr std::array<const char*, 4> kKeys{"newton", "munroe", "di_felice", "kehlenbeck_di_felice"};
  constexpr std::array kTable{Row{0.1, {0.988, 0.968, 0.941, 0.992}}, Row{0.2, {0.950, 0.911, 0.877, 0.960}},
                              Row{0.3, {0.889, 0.836, 0.807, 0.900}}, Row{0.4, {0.806, 0.747, 0.731, 0.813}},
                              Row{0.5, {0.702, 0.646, 0.647, 0.703}}, Row{0.6, {0.580, 0.535, 0.554, 0.575}},
                              Row{0.8, {0.297, 0.284, 0.330, 0.288}}};
  for (std::size_t law = 0; law < kKeys.size(); ++law) {
    double largest = 0;
    for (const Row& row : kTable) {
      const double f =
          sim::CalcWallFactor(sim::FindWallFactorLaw(kKeys[law]).law, row.diameter_ratio, sim::Reynolds(1e9));
      largest = std::fmax(largest, std::abs(f - row.factor[law]));
    }
    checks.AtMost(std::string(kKeys[law]) + ": error of the wall factor, d/D 0.1 to 0.8, high Re", largest,
                  6e-4, "table of three decimals");
  }
}

}  // namespace

void CheckDrag(const ReproduceOptions&, ReproduceReport& report) {
  FigureChecks checks(report, "drag");
  CheckDragTable(checks);
  CheckJumps(checks);
  CheckWallFactors(checks);
}

}  // namespace piperun::scenarios::physics
