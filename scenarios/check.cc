#include "scenarios/check.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/number.h"
#include "scenarios/run_json.h"

namespace piperun::scenarios {
namespace {

CheckedExpectation CheckText(const ExpectEntry& entry, const JsonValue& value) {
  const std::string found = value.text ? *value.text : value.number ? FormatNumber(*value.number) : "nothing";
  return {entry.path, found, "= " + entry.equals, found == entry.equals};
}

CheckedExpectation CheckNumber(const ExpectEntry& entry, const JsonValue& value) {
  Range range;
  if (entry.min) range.min = *entry.min;
  if (entry.max) range.max = *entry.max;
  CheckedExpectation checked{entry.path, "nothing", "in " + range.Text(), false};
  if (value.text) checked.found = "'" + *value.text + "'";
  if (value.number) {
    checked.found = FormatNumber(*value.number);
    checked.kept = range.Contains(*value.number);
  }
  return checked;
}

std::string EscapeXml(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    switch (c) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      default:
        escaped += c;
    }
  }
  return escaped;
}

}  // namespace

bool CheckedScenario::ok() const {
  return std::all_of(expectations.begin(), expectations.end(), [](const auto& e) { return e.kept; });
}

std::vector<CheckedExpectation> CheckExpectations(const std::vector<ExpectEntry>& expect,
                                                  const std::string& run_json) {
  std::vector<ExpectEntry> entries = expect;
  if (entries.empty()) entries.push_back({"/status", std::nullopt, std::nullopt, "ok"});
  std::vector<CheckedExpectation> checked;
  for (const ExpectEntry& entry : entries) {
    const JsonValue value = FindJson(run_json, entry.path);
    checked.push_back(entry.equals.empty() ? CheckNumber(entry, value) : CheckText(entry, value));
  }
  return checked;
}

std::string WriteCheckJson(const std::vector<CheckedScenario>& checked) {
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const CheckedScenario& scenario : checked) {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const CheckedExpectation& e : scenario.expectations) {
      list.push_back({{"path", e.path}, {"found", e.found}, {"allowed", e.allowed}, {"ok", e.kept}});
    }
    all.push_back({{"scenario", scenario.name}, {"ok", scenario.ok()}, {"expectations", list}});
  }
  return all.dump(2) + "\n";
}

std::string WriteCheckJunit(const std::vector<CheckedScenario>& checked) {
  const auto failures = std::count_if(checked.begin(), checked.end(), [](const auto& c) { return !c.ok(); });
  std::string xml = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuite name=\"piperun check\" tests=\"" +
                    std::to_string(checked.size()) + "\" failures=\"" + std::to_string(failures) + "\">\n";
  for (const CheckedScenario& scenario : checked) {
    xml += "  <testcase classname=\"piperun.check\" name=\"" + EscapeXml(scenario.name) + "\" time=\"" +
           FormatNumber(scenario.wall_s) + "\">\n";
    for (const CheckedExpectation& e : scenario.expectations) {
      if (e.kept) continue;
      xml += "    <failure message=\"" + EscapeXml(e.path + " is " + e.found + ", expected " + e.allowed) +
             "\"/>\n";
    }
    xml += "  </testcase>\n";
  }
  return xml + "</testsuite>\n";
}

}  // namespace piperun::scenarios
