#include <string>

#include "sim/network/inp_draft.h"
#include "sim/network/pump_law.h"

namespace piperun::sim {
namespace {

void AddIndex(const InpLine& line, InpDraft& draft, int index) {
  if (!draft.link_index.try_emplace(line[0], index).second) {
    line.Fail("the link id '" + line[0] +
              "' is used twice; give every pipe, pump and valve an id of its own");
  }
}

template <class Link>
void ReadEnds(const InpLine& line, const InpDraft& draft, Link& link) {
  link.id = line[0];
  link.from = ReadNode(line, 1, draft);
  link.to = ReadNode(line, 2, draft);
  if (link.from == link.to)
    line.Fail("both ends are node '" + line[1] + "'; a link joins two different nodes");
}

/// Status words of a pipe: OPEN, CLOSED, CV.
bool ReadPipeStatus(const InpLine& line, std::size_t word, PipeLink& pipe) {
  if (BeginsWith(line[word], "CV")) {
    pipe.check_valve = true;
  } else if (const auto status = FindStatus(line[word])) {
    pipe.status = *status;
  } else {
    return false;
  }
  return true;
}

void ReadPipe(const InpLine& line, InpDraft& draft) {
  line.RequireWords(6, "id node1 node2 length diameter roughness (minor-loss) (status)");
  const bool is_sand = draft.model.options.law == HeadLossLaw::kDarcyWeisbach;
  PipeLink pipe;
  ReadEnds(line, draft, pipe);
  pipe.length_m = draft.units.length_m * ReadNumber(line, 3, "length", Range::Positive());
  pipe.diameter_m = draft.units.diameter_m * ReadNumber(line, 4, "diameter", Range::Positive());
  pipe.roughness = ReadNumber(line, 5, "roughness", Range::Positive());
  if (is_sand) pipe.roughness *= draft.units.roughness_m;
  std::size_t word = 6;
  if (word < line.size() && !ReadPipeStatus(line, word, pipe)) {
    pipe.minor_loss = ReadNumber(line, word, "minor loss", Range::NonNegative());
    if (++word < line.size() && !ReadPipeStatus(line, word, pipe)) {
      line.Fail("the status is '" + line[word] + "'; allowed: OPEN, CLOSED, CV");
    }
  }
  AddIndex(line, draft, draft.model.first_pump());
  draft.model.pipes.push_back(std::move(pipe));
}

void ReadPumpKeyword(const InpLine& line, std::size_t word, InpDraft& draft, PumpLink& pump) {
  const std::string& key = line[word];
  if (BeginsWith(key, "POWER")) {
    pump.kind = PumpKind::kConstantPower;
    pump.power_W = draft.units.power_W * ReadNumber(line, word + 1, "power", Range::Positive());
  } else if (BeginsWith(key, "HEAD")) {
    pump.curve = ReadCurve(line, word + 1, draft, draft.units.flow_m3_s, draft.units.length_m);
    pump.kind = FindPumpKind(pump.curve);
  } else if (BeginsWith(key, "PATT")) {
    pump.pattern = ReadPattern(line, word + 1, draft);
  } else if (BeginsWith(key, "SPEE")) {
    pump.speed = ReadNumber(line, word + 1, "speed", Range::NonNegative());
  } else {
    line.Fail("'" + key +
              "' is not a pump's keyword; allowed: HEAD, POWER, SPEED, PATTERN, each with a value");
  }
}

void ReadPump(const InpLine& line, InpDraft& draft) {
  line.RequireWords(5, "id node1 node2 HEAD curve | POWER value (SPEED value) (PATTERN id)");
  PumpLink pump;
  ReadEnds(line, draft, pump);
  for (std::size_t word = 3; word < line.size(); word += 2) ReadPumpKeyword(line, word, draft, pump);
  if (pump.power_W == 0 && pump.curve.empty())
    line.Fail("the pump has neither a HEAD curve nor a POWER; give one");
  if (!pump.curve.empty()) pump.kind = FindPumpKind(pump.curve);  // a curve goes before a power, as in EPANET
  std::string problem;
  if (!CalcPumpLaw(pump.kind, pump.curve, &problem)) line.Fail("the pump's curve " + problem);
  AddIndex(line, draft, draft.model.first_valve());
  draft.model.pumps.push_back(std::move(pump));
}

ValveKind ReadValveKind(const InpLine& line) {
  constexpr const char* kNames[] = {"PRV", "PSV", "PBV", "FCV", "TCV", "GPV", "PCV"};
  for (int i = 0; i < 7; ++i) {
    if (BeginsWith(line[4], kNames[i])) return static_cast<ValveKind>(i);
  }
  line.Fail("the valve type is '" + line[4] + "'; allowed: PRV, PSV, PBV, FCV, TCV, GPV, PCV");
}

bool IsPressureOrFlowControl(ValveKind kind) {
  return kind == ValveKind::kPressureReducing || kind == ValveKind::kPressureSustaining ||
         kind == ValveKind::kFlowControl;
}

/// Two valves that pin the same head, or feed each other, have no solution (EPANET's error 220).
bool Conflict(const ValveLink& a, const ValveLink& b) {
  using enum ValveKind;
  if (a.kind == kPressureReducing && b.kind == kPressureReducing) {
    return a.to == b.to || a.to == b.from || a.from == b.to;
  }
  if (a.kind == kPressureSustaining && b.kind == kPressureSustaining) {
    return a.from == b.from || a.from == b.to || a.to == b.from;
  }
  const bool a_pins_to = a.kind == kPressureReducing, a_pins_from = a.kind == kPressureSustaining;
  if (a_pins_to && (b.kind == kPressureSustaining || b.kind == kFlowControl)) return a.to == b.from;
  if (a_pins_from && b.kind == kFlowControl) return a.from == b.to;
  return false;
}

void RequirePlace(const InpLine& line, const InpDraft& draft, const ValveLink& valve) {
  if (!IsPressureOrFlowControl(valve.kind)) return;
  if (!draft.IsJunction(valve.from) || !draft.IsJunction(valve.to)) {
    line.Fail("a " + line[4] + " may not touch a reservoir or tank; put a short pipe between them");
  }
  for (const ValveLink& other : draft.model.valves) {
    if (Conflict(valve, other) || Conflict(other, valve)) {
      line.Fail("the valve and valve '" + other.id + "' control the same node; put a pipe between them");
    }
  }
}

double SettingUnit(ValveKind kind, const InpUnits& units) {
  using enum ValveKind;
  if (kind == kFlowControl) return units.flow_m3_s;
  const bool is_pressure =
      kind == kPressureReducing || kind == kPressureSustaining || kind == kPressureBreaker;
  return is_pressure ? units.pressure_m : 1;
}

void ReadSetting(const InpLine& line, InpDraft& draft, ValveLink& valve) {
  if (valve.kind == ValveKind::kGeneralPurpose) {
    valve.curve = ReadCurve(line, 5, draft, draft.units.flow_m3_s, draft.units.length_m);
    if (valve.curve.size() < 2)
      line.Fail("the head loss curve '" + line[5] + "' must have two points or more");
    valve.status = LinkStatus::kOpen;
    return;
  }
  const bool may_be_negative =
      valve.kind == ValveKind::kPressureReducing || valve.kind == ValveKind::kPressureSustaining;
  valve.setting = SettingUnit(valve.kind, draft.units) *
                  ReadNumber(line, 5, "setting", may_be_negative ? Range::Any() : Range::NonNegative());
}

void ReadValve(const InpLine& line, InpDraft& draft) {
  line.RequireWords(6, "id node1 node2 diameter type setting (minor-loss) (curve)");
  ValveLink valve;
  ReadEnds(line, draft, valve);
  valve.diameter_m = draft.units.diameter_m * ReadNumber(line, 3, "diameter", Range::Positive());
  valve.kind = ReadValveKind(line);
  ReadSetting(line, draft, valve);
  if (line.size() > 6) valve.minor_loss = ReadNumber(line, 6, "minor loss", Range::NonNegative());
  if (line.size() > 7 && valve.kind == ValveKind::kPositional) valve.curve = ReadCurve(line, 7, draft, 1, 1);
  RequirePlace(line, draft, valve);
  AddIndex(line, draft, draft.model.link_count());
  draft.model.valves.push_back(std::move(valve));
}

void SetPumpStatus(const InpLine& line, std::optional<LinkStatus> status, double value, PumpLink& pump) {
  if (value < 0) line.Fail("the speed is negative; it must be >= 0");
  pump.speed = status ? (*status == LinkStatus::kOpen ? 1 : 0) : value;
  pump.status = pump.speed > 0 ? LinkStatus::kOpen : LinkStatus::kClosed;
}

void SetStatus(const InpLine& line, int link, bool alone, InpDraft& draft) {
  const std::size_t word = line.size() - 1;
  const auto status = FindStatus(line[word]);
  const double value =
      status ? 0 : ReadNumber(line, word, "status (OPEN, CLOSED or a setting)", Range::NonNegative());
  if (PipeLink* pipe = draft.FindPipe(link)) {
    if (pipe->check_valve && alone) line.Fail("the status of a check valve cannot be set; remove the line");
    if (status && !pipe->check_valve) pipe->status = *status;
  } else if (PumpLink* pump = draft.FindPump(link)) {
    SetPumpStatus(line, status, value, *pump);
  } else {
    ValveLink& valve = *draft.FindValve(link);
    const bool is_curve = valve.kind == ValveKind::kGeneralPurpose;
    if (is_curve && !status) line.Fail("a GPV has a curve, no setting; write OPEN or CLOSED");
    valve.status = status.value_or(LinkStatus::kActive);
    if (!status) valve.setting = value * SettingUnit(valve.kind, draft.units);
  }
}

/// Is the id between two others, by number when all are numbers?
bool IsBetween(const std::string& id, const std::string& first, const std::string& last) {
  const auto number = [](const std::string& text) { return std::strtol(text.c_str(), nullptr, 10); };
  if (number(first) > 0 && number(last) > 0) return number(id) >= number(first) && number(id) <= number(last);
  return first <= id && id <= last;
}

void ReadStatus(const InpLine& line, InpDraft& draft) {
  line.RequireWords(2, "link (last-link) OPEN|CLOSED|setting");
  if (line.size() == 2) return SetStatus(line, ReadLink(line, 0, draft), true, draft);
  for (int link = 0; link < draft.model.link_count(); ++link) {
    if (IsBetween(draft.model.LinkId(link), line[0], line[1])) SetStatus(line, link, false, draft);
  }
}

}  // namespace

double SettingUnit(const InpDraft& draft, int link) {
  const int valve = link - draft.model.first_valve();
  return valve < 0 ? 1 : SettingUnit(draft.model.valves[valve].kind, draft.units);
}

void ReadLinks(const InpSections& sections, InpDraft& draft) {
  for (const InpLine& line : Lines(sections, InpSection::kPipes)) ReadPipe(line, draft);
  for (const InpLine& line : Lines(sections, InpSection::kPumps)) ReadPump(line, draft);
  for (const InpLine& line : Lines(sections, InpSection::kValves)) ReadValve(line, draft);
  for (const InpLine& line : Lines(sections, InpSection::kStatus)) ReadStatus(line, draft);
}

}  // namespace piperun::sim
