#include "sim/network/inp_draft.h"

namespace piperun::sim {
namespace {

void ReadPatternLine(const InpLine& line, InpDraft& draft) {
  line.RequireWords(2, "id multiplier multiplier ...");
  auto& patterns = draft.model.patterns;
  const auto [found, is_new] = draft.pattern_index.try_emplace(line[0], static_cast<int>(patterns.size()));
  if (is_new) patterns.push_back({line[0], {}});
  for (std::size_t i = 1; i < line.size(); ++i) {
    patterns[found->second].multipliers.push_back(ReadNumber(line, i, "multiplier"));
  }
}

void ReadCurveLine(const InpLine& line, InpDraft& draft) {
  line.RequireWords(3, "id x y");
  const CurvePoint point{ReadNumber(line, 1, "x"), ReadNumber(line, 2, "y")};
  InpDraft::RawCurve& curve = draft.curves[line[0]];
  if (!curve.points.empty() && point.x <= curve.points.back().x) {
    line.Fail("x is " + line[1] + ", after " + (*curve.line)[1] + "; the x values of a curve must rise");
  }
  curve.points.push_back(point);
  curve.line = &line;
}

/// EPANET names pattern 1 as the default in every file, whether there is one or not.
void FindDefaultPattern(InpDraft& draft) {
  const auto found = draft.pattern_index.find(draft.default_pattern_id);
  if (found != draft.pattern_index.end()) {
    draft.default_pattern = found->second;
  } else if (draft.default_pattern_line != nullptr && draft.default_pattern_id != "1") {
    draft.default_pattern_line->Fail("there is no pattern '" + draft.default_pattern_id +
                                     "'; it must stand in [PATTERNS]");
  }
}

}  // namespace

void ReadPatternsAndCurves(const InpSections& sections, InpDraft& draft) {
  for (const InpLine& line : Lines(sections, InpSection::kPatterns)) ReadPatternLine(line, draft);
  for (const InpLine& line : Lines(sections, InpSection::kCurves)) ReadCurveLine(line, draft);
  FindDefaultPattern(draft);
}

}  // namespace piperun::sim
