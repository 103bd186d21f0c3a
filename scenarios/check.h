#pragma once

#include <string>
#include <vector>

#include "scenarios/scenario.h"

namespace piperun::scenarios {

/// One promise of a scenario and what came of it.
struct CheckedExpectation {
  std::string path;
  std::string found;    ///< value in run.json, or "nothing"
  std::string allowed;  ///< "in [0, 0.1]", "= ok"
  bool kept = false;
};

/// A scenario after its run.
struct CheckedScenario {
  std::string name;
  double wall_s = 0;
  std::vector<CheckedExpectation> expectations;

  bool ok() const;
};

/// Holds run.json to the scenario's `expect:`. A scenario without any is only expected to end with status ok.
std::vector<CheckedExpectation> CheckExpectations(const std::vector<ExpectEntry>& expect,
                                                  const std::string& run_json);

/// The outcome for programs: JSON, and JUnit's XML for continuous integration.
std::string WriteCheckJson(const std::vector<CheckedScenario>& checked);
std::string WriteCheckJunit(const std::vector<CheckedScenario>& checked);

}  // namespace piperun::scenarios
