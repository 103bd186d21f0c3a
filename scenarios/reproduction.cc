#include "scenarios/reproduction.h"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace piperun::scenarios {

bool ReproduceReport::passed() const {
  return std::all_of(figures.begin(), figures.end(), [](const ReproducedFigure& f) { return f.passed; });
}

std::string WriteReproduceJson(const Reproduction& reproduction, const ReproduceReport& report) {
  using Json = nlohmann::ordered_json;
  Json tables = Json::array(), figures = Json::array();
  for (const ReproducedTable& table : report.tables) {
    tables.push_back({{"title", table.title}, {"head", table.head}, {"rows", table.rows}});
  }
  for (const ReproducedFigure& f : report.figures) {
    figures.push_back({{"what", f.what},
                       {"measured", f.measured},
                       {"expected", f.expected},
                       {"source", f.source},
                       {"passed", f.passed}});
  }
  const Json json{{"schema", "piperun.reproduce/1"},
                  {"name", reproduction.name},
                  {"passed", report.passed()},
                  {"figures", figures},
                  {"tables", tables}};
  return json.dump(2) + "\n";
}

}  // namespace piperun::scenarios
