#include <cmath>

#include "sim/network/inp_draft.h"

namespace piperun::sim {
namespace {

constexpr std::int64_t kDay_s = 86400;

/// Head at which a control acts: a level in a tank, a head difference above a reservoir, a pressure
/// elsewhere.
double ReadGrade(const InpLine& line, const InpDraft& draft, int node) {
  const double unit = draft.IsJunction(node) ? draft.units.pressure_m : draft.units.length_m;
  return draft.model.Elevation_m(node) + unit * ReadNumber(line, 7, "level or pressure");
}

void ReadCondition(const InpLine& line, const InpDraft& draft, SimpleControl& control) {
  if (BeginsWith(line[4], "CLOCKTIME") || BeginsWith(line[4], "TIME")) {
    const bool clock = BeginsWith(line[4], "CLOCKTIME");
    control.when = clock ? SimpleControl::When::kClockTime : SimpleControl::When::kTime;
    control.time_s = ReadTime(line, 5);
    if (clock) control.time_s %= kDay_s;
    return;
  }
  line.RequireWords(8, "LINK id setting IF NODE id ABOVE|BELOW value");
  control.node = ReadNode(line, 5, draft);
  if (!BeginsWith(line[6], "BELOW") && !BeginsWith(line[6], "ABOVE")) {
    line.Fail("'" + line[6] + "' must be ABOVE or BELOW");
  }
  control.when = BeginsWith(line[6], "BELOW") ? SimpleControl::When::kBelow : SimpleControl::When::kAbove;
  control.head_m = ReadGrade(line, draft, control.node);
}

SimpleControl ReadControl(const InpLine& line, InpDraft& draft) {
  line.RequireWords(
      6, "LINK id setting IF NODE id ABOVE|BELOW value, or LINK id setting AT TIME|CLOCKTIME time");
  SimpleControl control;
  control.action = ReadLinkAction(line, 1, 2, draft);
  ReadCondition(line, draft, control);
  return control;
}

/// Takes DISABLED off the end of a control.
bool TakeDisabled(InpLine& line) {
  if (!BeginsWith(line.words.back(), "DISABLED")) return false;
  line.words.pop_back();
  return true;
}

}  // namespace

LinkAction ReadLinkAction(const InpLine& line, std::size_t link_word, std::size_t value_word,
                          InpDraft& draft) {
  LinkAction action{ReadLink(line, link_word, draft), {}, {}};
  const PipeLink* pipe = draft.FindPipe(action.link);
  const ValveLink* valve = draft.FindValve(action.link);
  if (pipe != nullptr && pipe->check_valve) line.Fail("a check valve cannot be controlled");
  action.status = FindStatus(line[value_word]);
  if (action.status) return action;
  if (valve != nullptr && valve->kind == ValveKind::kGeneralPurpose) {
    line.Fail("a GPV has a curve, no setting; write OPEN or CLOSED");
  }
  const double value =
      ReadNumber(line, value_word, "setting (OPEN, CLOSED or a number)", Range::NonNegative());
  if (pipe != nullptr) {
    action.status = value == 0 ? LinkStatus::kClosed : LinkStatus::kOpen;
  } else {
    action.setting = value * SettingUnit(draft, action.link);
  }
  return action;
}

void ReadControls(const InpSections& sections, InpDraft& draft) {
  for (InpLine line : Lines(sections, InpSection::kControls)) {
    const bool disabled = TakeDisabled(line);
    SimpleControl control = ReadControl(line, draft);
    control.enabled = !disabled;
    draft.model.controls.push_back(control);
  }
}

}  // namespace piperun::sim
