#pragma once

#include <string>

#include "scenarios/allan_analysis.h"

namespace piperun::tools {

/// The record, a table of terms per channel in data-sheet units and in SI, and the notes.
std::string DescribeAllan(const scenarios::AllanAnalysis& analysis);

}  // namespace piperun::tools
