#include "scenarios/reference.h"

#include "base/number.h"
#include "scenarios/ball_presets.h"
#include "scenarios/scenario.h"
#include "scenarios/sensor_presets.h"
#include "scenarios/unit_alias.h"

namespace piperun::scenarios {
namespace {

std::string Joined(std::span<const double> values) {
  std::string text;
  for (const double value : values) text += (text.empty() ? "" : ", ") + FormatNumber(value);
  return "[" + text + "]";
}

/// One table row per field; groups and lists prefix their fields' names.
class ReferenceWriter : public ParamVisitor {
 public:
  ReferenceWriter(std::string& out, std::string prefix) : out_(out), prefix_(std::move(prefix)) {}

  void Number(const ParamInfo& info, const Range& range, double& value) override {
    Row(info, FormatNumber(value), range.Text());
  }
  void NumberOr(const ParamInfo& info, const Range& range, std::string_view none,
                std::optional<double>& value) override {
    Row(info, value ? FormatNumber(*value) : std::string(none),
        range.Text() + ", or `" + std::string(none) + "`");
  }
  void Integer(const ParamInfo& info, std::int64_t min, std::int64_t max, std::int64_t& value) override {
    const std::string high = max == INT64_MAX ? "" : " to " + std::to_string(max);
    Row(info, std::to_string(value), "whole number from " + std::to_string(min) + high);
  }
  void Flag(const ParamInfo& info, bool& value) override {
    Row(info, value ? "true" : "false", "true, false");
  }
  void Text(const ParamInfo& info, std::string& value) override { Row(info, "\"" + value + "\"", "text"); }
  void Choice(const ParamInfo& info, std::span<const std::string_view> allowed, std::string& value) override {
    std::string names;
    for (const std::string_view name : allowed) names += (names.empty() ? "" : ", ") + std::string(name);
    Row(info, value, names);
  }
  void Array(const ParamInfo& info, const Range& range, std::span<double> values) override {
    Row(info, Joined(values), std::to_string(values.size()) + " numbers, each " + range.Text());
  }
  void Table(const ParamInfo& info, const Range& range, std::size_t columns, std::vector<double>&) override {
    Row(info, "[]", "rows of " + std::to_string(columns) + " numbers, each " + range.Text());
  }
  void Group(const ParamInfo& info, const std::function<void(ParamVisitor&)>& visit) override {
    Nested(std::string(info.name) + ".", visit);
  }
  void List(const ParamInfo& info, ParamList& list) override {
    list.Resize(1);
    Nested(std::string(info.name) + "[].", [&](ParamVisitor& v) { list.VisitItem(0, v); });
  }
  void Map(const ParamInfo& info, ParamMap& map) override {
    if (map.Names().empty()) map.Add("NAME");
    Nested(std::string(info.name) + ".NAME.", [&](ParamVisitor& v) { map.VisitItem(0, v); });
  }

 private:
  void Nested(const std::string& step, const std::function<void(ParamVisitor&)>& visit) {
    ReferenceWriter nested(out_, prefix_ + step);
    visit(nested);
  }
  void Row(const ParamInfo& info, const std::string& value, const std::string& allowed) {
    std::string doc(info.doc);
    const auto aliases = FindUnitAliases(info.name);
    if (!aliases.empty()) {
      doc += " Also as";
      for (const UnitAlias& alias : aliases) doc += " `" + alias.key + "`";
      doc += ".";
    }
    out_ += "| `" + prefix_ + std::string(info.name) + "` | " + (info.required ? "required" : value) + " | " +
            allowed + " | " + doc + " |\n";
  }

  std::string& out_;
  std::string prefix_;
};

constexpr char kHead[] = "| key | default | allowed | meaning |\n| --- | --- | --- | --- |\n";

void WriteKinds(std::string& out, const std::string& title, const std::vector<KindOption>& options) {
  for (const KindOption& option : options) {
    out += "\n## " + title + " `" + std::string(option.name) + "`\n\n" + std::string(option.doc) + "\n\n" +
           kHead;
    ReferenceWriter writer(out, "");
    option.make_params()->Visit(writer);
  }
}

void WritePresets(std::string& out) {
  out += "\n## Ball presets\n\nValues of `ball: {preset: NAME}`, with their sources in `assets/balls`.\n\n";
  for (const BallPreset& preset : BallPresets()) {
    out += "- `" + std::string(preset.name) + "`: " + preset.description + ".\n";
  }
  out +=
      "\n## Sensor presets\n\nValues of `sensors: {NAME: {kind: KIND, preset: NAME}}`, with their sources in "
      "`assets/sensors`.\n\n";
  for (const SensorPreset& preset : SensorPresets()) {
    out += "- `" + preset.name + "` (" + preset.Kinds() + "): " + preset.description + ".\n";
  }
}

}  // namespace

std::string WriteReference() {
  std::string out =
      "# Scenario reference\n\nEvery key of a scenario file. Values are SI; a key may be spelt with another "
      "unit "
      "where the table says so.\n\n";
  out += kHead;
  Scenario scenario;
  ReferenceWriter writer(out, "");
  scenario.Visit(writer);
  WritePresets(out);
  WriteKinds(out, "Motion", MotionOptions());
  WriteKinds(out, "Sensor", SensorOptions());
  WriteKinds(out, "Leak sound", LeakSoundOptions());
  WriteKinds(out, "Sound", SoundOptions());
  WriteKinds(out, "Wall feature", WallFeatureOptions());
  WriteKinds(out, "Estimator", FilterOptions());
  return out;
}

}  // namespace piperun::scenarios
