#include "sim/network/inp_draft.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/number.h"

namespace piperun::sim {
namespace {

constexpr double kSecondsPerHour = 3600;
constexpr double kMaxTime_s = 100 * 366.0 * 86400;  // a century

/// A number as C reads it: "1.", ".5", "1e3", "+2"; not "0x1", "nan", "inf".
std::optional<double> FindNumber(std::string_view word) {
  if (word.starts_with('.')) return ParseNumber("0" + std::string(word));
  if (word.starts_with("-.")) return ParseNumber("-0" + std::string(word.substr(1)));
  return ParseNumber(word);
}

/// Hours in "h", "h:m" or "h:m:s".
std::optional<double> FindHours(std::string_view word) {
  std::array<double, 3> parts{};
  for (double& part : parts) {
    const std::size_t colon = std::min(word.find(':'), word.size());
    const auto number = FindNumber(word.substr(0, colon));
    if (!number || *number < 0) return std::nullopt;
    part = *number;
    if (colon == word.size()) return parts[0] + parts[1] / 60 + parts[2] / 3600;
    word.remove_prefix(colon + 1);
  }
  return std::nullopt;
}

/// Hours after midnight of a clock's face.
std::optional<double> FromClockFace(double hours, bool afternoon) {
  if (hours >= 13) return std::nullopt;
  return std::fmod(hours, 12) + (afternoon ? 12 : 0);
}

std::optional<double> ApplyTimeUnit(double value, std::string_view unit) {
  if (BeginsWith(unit, "SEC")) return value / kSecondsPerHour;
  if (BeginsWith(unit, "MIN")) return value / 60;
  if (BeginsWith(unit, "HOU")) return value;
  if (BeginsWith(unit, "DAY")) return value * 24;
  if (BeginsWith(unit, "AM")) return FromClockFace(value, false);
  if (BeginsWith(unit, "PM")) return FromClockFace(value, true);
  return std::nullopt;
}

int FindIndex(const InpLine& line, std::size_t word, const std::unordered_map<std::string, int>& index,
              const char* what, const char* where) {
  line.RequireWords(word + 1, what);
  const auto found = index.find(line[word]);
  if (found == index.end()) {
    line.Fail(std::string("there is no ") + what + " '" + line[word] + "'; it must stand in " + where);
  }
  return found->second;
}

}  // namespace

PipeLink* InpDraft::FindPipe(int link) { return link < model.first_pump() ? &model.pipes[link] : nullptr; }

PumpLink* InpDraft::FindPump(int link) {
  const int pump = link - model.first_pump();
  return pump >= 0 && link < model.first_valve() ? &model.pumps[pump] : nullptr;
}

ValveLink* InpDraft::FindValve(int link) {
  const int valve = link - model.first_valve();
  return valve >= 0 ? &model.valves[valve] : nullptr;
}

double ReadNumber(const InpLine& line, std::size_t word, const char* what, const Range& range) {
  line.RequireWords(word + 1, what);
  const auto number = FindNumber(line[word]);
  if (!number) line.Fail(std::string(what) + " is '" + line[word] + "'; it must be a number");
  if (!range.Contains(*number)) {
    line.Fail(std::string(what) + " is " + line[word] + "; allowed: " + range.Text());
  }
  return *number;
}

int ReadNode(const InpLine& line, std::size_t word, const InpDraft& draft) {
  return FindIndex(line, word, draft.node_index, "node", "[JUNCTIONS], [RESERVOIRS] or [TANKS]");
}

int ReadLink(const InpLine& line, std::size_t word, const InpDraft& draft) {
  return FindIndex(line, word, draft.link_index, "link", "[PIPES], [PUMPS] or [VALVES]");
}

int ReadPattern(const InpLine& line, std::size_t word, const InpDraft& draft) {
  return FindIndex(line, word, draft.pattern_index, "pattern", "[PATTERNS]");
}

Curve ReadCurve(const InpLine& line, std::size_t word, const InpDraft& draft, double x_unit, double y_unit) {
  line.RequireWords(word + 1, "curve");
  const auto found = draft.curves.find(line[word]);
  if (found == draft.curves.end()) {
    line.Fail("there is no curve '" + line[word] + "'; it must stand in [CURVES]");
  }
  Curve curve = found->second.points;
  for (CurvePoint& point : curve) {
    point.x *= x_unit;
    point.y *= y_unit;
  }
  return curve;
}

std::int64_t ReadTime(const InpLine& line, std::size_t word) {
  line.RequireWords(word + 1, "time");
  auto hours = FindHours(line[word]);
  if (hours && word + 1 < line.size()) hours = ApplyTimeUnit(*hours, line[word + 1]);
  if (!hours || *hours * kSecondsPerHour > kMaxTime_s) {
    line.Fail(
        "the time '" + line[word] + (word + 1 < line.size() ? " " + line[word + 1] : "") +
        "' is not one; write hours (1.5), h:mm:ss, or a number with SEC, MIN, HOURS, DAYS, AM or PM, at "
        "most a century");
  }
  return std::llround(*hours * kSecondsPerHour);
}

std::optional<LinkStatus> FindStatus(std::string_view word) {
  if (BeginsWith(word, "OPEN")) return LinkStatus::kOpen;
  if (BeginsWith(word, "CLOSED")) return LinkStatus::kClosed;
  return std::nullopt;
}

}  // namespace piperun::sim
