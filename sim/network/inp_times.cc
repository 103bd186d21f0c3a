#include <algorithm>
#include <string>
#include <vector>

#include "sim/network/inp_draft.h"

namespace piperun::sim {
namespace {

constexpr std::int64_t kDay_s = 86400;

/// The word where a line's time begins: the last one, or the last but one when a unit follows.
std::size_t TimeWord(const InpLine& line) {
  line.RequireWords(2, "KEYWORD time");
  const std::string& last = line[line.size() - 1];
  const bool has_unit = last[0] < '0' || last[0] > '9';
  const bool is_number = last[0] == '.' || last[0] == '-' || last[0] == '+';
  return line.size() - (has_unit && !is_number && line.size() > 2 ? 2 : 1);
}

std::int64_t* FindField(const InpLine& line, HydraulicTimes& times) {
  const std::string& key = line[0];
  const bool is_start = line.size() > 1 && BeginsWith(line[1], "STAR");
  if (BeginsWith(key, "DURA")) return &times.duration_s;
  if (BeginsWith(key, "HYDR")) return &times.hydraulic_step_s;
  if (BeginsWith(key, "RULE")) return &times.rule_step_s;
  if (BeginsWith(key, "PATT")) return is_start ? &times.pattern_start_s : &times.pattern_step_s;
  if (BeginsWith(key, "REPO")) return is_start ? &times.report_start_s : &times.report_step_s;
  if (BeginsWith(key, "STAR")) return &times.start_clock_s;
  return nullptr;
}

bool IsStep(const InpLine& line) { return BeginsWith(line[1], "TIME"); }

/// EPANET's defaults, which a step of 0 asks for, and its rule that no step is longer than those it serves.
void Complete(HydraulicTimes& times, std::vector<std::string>& notes) {
  if (times.pattern_step_s == 0) times.pattern_step_s = 3600;
  if (times.report_step_s == 0) times.report_step_s = times.pattern_step_s;
  if (times.hydraulic_step_s == 0) times.hydraulic_step_s = 3600;
  times.hydraulic_step_s = std::min({times.hydraulic_step_s, times.pattern_step_s, times.report_step_s});
  if (times.report_start_s > times.duration_s) {
    notes.push_back("[TIMES] REPORT START lies behind the end of the period: every step is reported");
    times.report_start_s = 0;
  }
  if (times.rule_step_s == 0) times.rule_step_s = times.hydraulic_step_s / 10;
  times.rule_step_s = std::max<std::int64_t>(1, std::min(times.rule_step_s, times.hydraulic_step_s));
  times.start_clock_s %= kDay_s;
}

}  // namespace

void ReadTimes(const InpSections& sections, InpDraft& draft) {
  HydraulicTimes& times = draft.model.times;
  times.rule_step_s = 0;
  for (const InpLine& line : Lines(sections, InpSection::kTimes)) {
    if (BeginsWith(line[0], "STAT")) {
      if (line.size() > 1 && !BeginsWith(line[1], "NO")) {
        draft.model.notes.push_back("[TIMES] STATISTIC " + line[1] +
                                    ": every step is kept, no statistic formed");
      }
    } else if (BeginsWith(line[0], "QUAL") || BeginsWith(line[0], "MINI")) {
      continue;  // steps of the water quality, which nobody asks for
    } else if (std::int64_t* field = FindField(line, times)) {
      *field = ReadTime(line, TimeWord(line));
      if (*field == 0 && IsStep(line)) {
        draft.model.notes.push_back("[TIMES] " + line[0] + " " + line[1] + " 0: EPANET's default is used");
      }
    } else {
      line.Fail(
          "unknown time; known are DURATION, HYDRAULIC TIMESTEP, PATTERN TIMESTEP, PATTERN START, REPORT "
          "TIMESTEP, REPORT START, RULE TIMESTEP, START CLOCKTIME, STATISTIC");
    }
  }
  Complete(times, draft.model.notes);
}

}  // namespace piperun::sim
