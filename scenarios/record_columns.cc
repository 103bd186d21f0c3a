#include "scenarios/record_columns.h"

#include <algorithm>
#include <charconv>

#include "base/check.h"
#include "base/number.h"
#include "scenarios/nearest_name.h"
#include "scenarios/physical_unit.h"
#include "scenarios/record_unit.h"

namespace piperun::scenarios {
namespace {

/// "w_RS_S_x [rad s^-1]"
struct HeaderField {
  std::string name;
  std::string unit;  ///< empty: not told
};

std::string Trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" \t\r#\"");
  if (begin == std::string_view::npos) return "";
  return std::string(text.substr(begin, text.find_last_not_of(" \t\r\"") - begin + 1));
}

HeaderField ReadHeaderField(std::string_view text) {
  const std::string trimmed = Trimmed(text);
  const std::size_t open = trimmed.find('[');
  if (open == std::string::npos || trimmed.back() != ']') return {trimmed, ""};
  return {Trimmed(trimmed.substr(0, open)), Trimmed(trimmed.substr(open + 1, trimmed.size() - open - 2))};
}

std::vector<std::string_view> SplitFields(std::string_view line) {
  std::vector<std::string_view> fields;
  for (std::size_t begin = 0;;) {
    const std::size_t comma = line.find(',', begin);
    fields.push_back(line.substr(begin, comma - begin));
    if (comma == std::string_view::npos) return fields;
    begin = comma + 1;
  }
}

/// The first line of a file without a header is all numbers, finite or not.
bool IsHeader(const std::vector<std::string_view>& fields) {
  return std::any_of(fields.begin(), fields.end(), [](std::string_view f) {
    return !ParseNumber(Trimmed(f)).has_value() && !IsNotFinite(Trimmed(f));
  });
}

std::string NamesOf(const std::vector<HeaderField>& header) {
  std::string names;
  for (const HeaderField& field : header) names += (names.empty() ? "" : ", ") + field.name;
  return names;
}

std::size_t FindColumn(const std::string& name, const std::vector<HeaderField>& header, const char* option,
                       const std::string& where) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < header.size(); ++i) {
    if (header[i].name == name) return i;
    names.push_back(header[i].name);
  }
  std::size_t number = 0;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), number);
  const bool whole = error == std::errc{} && end == name.data() + name.size();
  if (whole && number >= 1 && number <= header.size()) return number - 1;
  const auto near = FindNearestName(name, names);
  throw InputError("there is no column '" + name + "'" + (near ? "; did you mean '" + *near + "'?" : "") +
                       " (the file has " + std::to_string(header.size()) + ": " + NamesOf(header) + ")",
                   option, where);
}

std::string Joined(const std::vector<std::string>& notes) {
  std::string text;
  for (const std::string& note : notes) text += "; " + note;
  return text;
}

const std::string* FindUnit(const StaticRecordOptions& options, const std::string& group) {
  for (const auto& [name, unit] : options.units) {
    if (name == group) return &unit;
  }
  return nullptr;
}

void AddColumn(RecordLayout& layout, const std::string& group, std::size_t field, const HeaderField& header,
               const std::string& unit) {
  const auto [factor, si] = ResolveGroupUnit(group, unit);
  if (layout.groups.empty() || layout.groups.back().name != group) layout.groups.push_back({group, si, {}});
  layout.groups.back().axes.push_back(header.name);
  layout.columns.push_back({field, factor});
}

void AddNamedColumns(RecordLayout& layout, const StaticRecordOptions& options,
                     const std::vector<HeaderField>& header, const std::string& where) {
  for (const auto& [group, names] : options.columns) {
    const std::string* unit = FindUnit(options, group);
    for (const std::string& name : names) {
      const std::size_t field = FindColumn(name, header, "--columns", where);
      const std::string& known = unit ? *unit : header[field].unit;
      if (known.empty()) {
        throw InputError("the unit of '" + group + "' is not told; add --unit " + group + "=UNIT", "--unit",
                         where);
      }
      AddColumn(layout, group, field, header[field], known);
    }
  }
}

/// gyro, accel, mag or pressure by what the unit measures; empty for anything else.
std::string GroupOfUnit(const std::string& unit) {
  const std::string si = SiUnitText(ParseUnit(unit, ""));
  if (si == "rad/s") return "gyro";
  if (si == "m/s^2") return "accel";
  if (si == "T") return "mag";
  if (si == "Pa") return "pressure";
  return "";
}

void AddColumnsByUnit(RecordLayout& layout, const StaticRecordOptions& options,
                      const std::vector<HeaderField>& header) {
  for (std::size_t i = 0; i < header.size(); ++i) {
    if (layout.time_field == i || header[i].unit.empty()) continue;
    try {
      const std::string group = GroupOfUnit(header[i].unit);
      const std::string* unit = FindUnit(options, group);
      if (!group.empty()) AddColumn(layout, group, i, header[i], unit ? *unit : header[i].unit);
    } catch (const InputError& e) {
      layout.notes.push_back("column '" + header[i].name + "' was left out: " + e.problem());
    }
  }
}

double TimeUnit_ns(const std::string& unit, const std::string& where) {
  if (unit.empty() || unit == "s") return 1e9;
  if (unit == "ms") return 1e6;
  if (unit == "us") return 1e3;
  if (unit == "ns") return 1;
  throw InputError("'" + unit + "' is no unit of time stamps; allowed: s ms us ns", "--time-unit", where);
}

void FindTime(RecordLayout& layout, const StaticRecordOptions& options,
              const std::vector<HeaderField>& header, const std::string& where) {
  if (!options.time_column.empty()) {
    layout.time_field = FindColumn(options.time_column, header, "--time-column", where);
  } else if (!header.empty() &&
             (header[0].name == "timestamp" || header[0].name == "time" || header[0].name == "t")) {
    layout.time_field = 0;
  }
  if (!layout.time_field) return;
  const std::string& told = header[*layout.time_field].unit;
  layout.time_unit_told = !options.time_unit.empty() || !told.empty();
  layout.time_unit_ns = TimeUnit_ns(options.time_unit.empty() ? told : options.time_unit, where);
}

}  // namespace

bool IsNotFinite(std::string_view text) {
  if (!text.empty() && (text.front() == '-' || text.front() == '+')) text.remove_prefix(1);
  for (const std::string_view word : {"", "nan", "NaN", "NAN", "inf", "Inf", "INF", "infinity"}) {
    if (text == word) return true;
  }
  return false;
}

std::pair<double, std::string> ResolveGroupUnit(const std::string& group, const std::string& unit) {
  constexpr std::pair<std::string_view, std::string_view> kUnits[] = {
      {"gyro", "rad/s"}, {"accel", "m/s^2"}, {"mag", "T"}, {"pressure", "Pa"}};
  const PhysicalUnit parsed = ParseUnit(unit, "--unit");
  const std::string si = SiUnitText(parsed);
  for (const auto& [name, wanted] : kUnits) {
    if (group == name && si != wanted) {
      throw InputError("'" + unit + "' does not measure what '" + group + "' does; it takes units of " +
                           std::string(wanted),
                       "--unit");
    }
  }
  return {parsed.factor, si};
}

RecordLayout ReadRecordLayout(std::string_view first_line, const StaticRecordOptions& options,
                              const std::string& where) {
  const auto fields = SplitFields(first_line);
  RecordLayout layout;
  layout.fields = fields.size();
  layout.has_header = IsHeader(fields);
  std::vector<HeaderField> header;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    header.push_back(layout.has_header ? ReadHeaderField(fields[i]) : HeaderField{std::to_string(i + 1), ""});
  }
  FindTime(layout, options, header, where);
  options.columns.empty() ? AddColumnsByUnit(layout, options, header)
                          : AddNamedColumns(layout, options, header, where);
  if (layout.columns.empty()) {
    throw InputError(
        "the header does not tell what is measured where; add --columns gyro=.. --unit gyro=.. "
        "(the file has " +
            std::to_string(header.size()) + " columns: " + NamesOf(header) + ")" + Joined(layout.notes),
        "--columns", where);
  }
  if (!layout.time_field && !options.rate_Hz) {
    throw InputError("there are no time stamps; add --rate HZ, or --time-column NAME", "--rate", where);
  }
  return layout;
}

}  // namespace piperun::scenarios
