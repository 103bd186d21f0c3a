#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "base/params.h"
#include "sim/network/inp_text.h"
#include "sim/network/model.h"

namespace piperun::sim {

/// What one unit of the file is in SI, read as EPANET reads it (a GPM is 1/448.831 ft3/s).
struct InpUnits {
  double length_m = 0;  ///< also elevation, head, level
  double diameter_m = 0;
  double roughness_m = 0;  ///< Darcy-Weisbach
  double flow_m3_s = 0;
  double pressure_m = 0;          ///< head per unit of pressure
  double emitter_pressure_m = 0;  ///< emitters keep psi or metres, whatever PRESSURE says
  double power_W = 0;
  double volume_m3() const { return length_m * length_m * length_m; }
};

/// A model half read: what later sections need to know of earlier ones.
struct InpDraft {
  struct RawCurve {
    Curve points;  ///< in units of the file; what they mean depends on who uses the curve
    const InpLine* line = nullptr;
  };
  HydraulicModel model;
  InpUnits units;
  std::unordered_map<std::string, int> node_index;
  std::unordered_map<std::string, int> link_index;
  std::unordered_map<std::string, int> pattern_index;
  std::unordered_map<std::string, RawCurve> curves;
  std::string default_pattern_id;                 ///< for demands that name none
  const InpLine* default_pattern_line = nullptr;  ///< null: EPANET's own default, "1" if there is one
  int default_pattern = -1;

  bool IsJunction(int node) const { return node < model.junction_count(); }
  bool IsTank(int node) const { return node >= model.first_tank(); }
  PipeLink* FindPipe(int link);
  PumpLink* FindPump(int link);
  ValveLink* FindValve(int link);
};

/// Words of a line as numbers and names; each fails with the line, the value and what is allowed.
double ReadNumber(const InpLine& line, std::size_t word, const char* what, const Range& range = Range::Any());
int ReadNode(const InpLine& line, std::size_t word, const InpDraft& draft);
int ReadLink(const InpLine& line, std::size_t word, const InpDraft& draft);
int ReadPattern(const InpLine& line, std::size_t word, const InpDraft& draft);
/// A curve with its axes multiplied by the given units.
Curve ReadCurve(const InpLine& line, std::size_t word, const InpDraft& draft, double x_unit, double y_unit);
/// Seconds: "3600 SEC", "1:30", "1:30:15", "7 AM", "2 DAYS"; a bare number counts hours.
std::int64_t ReadTime(const InpLine& line, std::size_t word);
/// What a setting of the link is multiplied with: a valve's pressure or flow unit, 1 for a pump's speed.
double SettingUnit(const InpDraft& draft, int link);
/// An action from the words of a link and of a status or setting.
LinkAction ReadLinkAction(const InpLine& line, std::size_t link_word, std::size_t value_word,
                          InpDraft& draft);
/// OPEN or CLOSED, or nothing.
std::optional<LinkStatus> FindStatus(std::string_view word);

/// One function per group of sections, to be called in this order.
void ReadOptions(const InpSections& sections, InpDraft& draft);
void ReadTimes(const InpSections& sections, InpDraft& draft);
void ReadPatternsAndCurves(const InpSections& sections, InpDraft& draft);
void ReadNodes(const InpSections& sections, InpDraft& draft);
void ReadLinks(const InpSections& sections, InpDraft& draft);
void ReadOutflows(const InpSections& sections, InpDraft& draft);
void ReadControls(const InpSections& sections, InpDraft& draft);
void ReadRules(const InpSections& sections, InpDraft& draft);
void ReadMap(const InpSections& sections, InpDraft& draft);
void NoteWhatIsIgnored(const InpSections& sections, InpDraft& draft);
/// Fails when a part of the network hangs on no reservoir or tank.
void RequireConnected(const InpSections& sections, const InpDraft& draft);

inline const std::vector<InpLine>& Lines(const InpSections& sections, InpSection section) {
  return sections.lines[static_cast<std::size_t>(section)];
}

}  // namespace piperun::sim
