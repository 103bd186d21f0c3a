// The writing half: a ParamVisitor that emits YAML.

#include <yaml-cpp/yaml.h>

#include "base/number.h"
#include "scenarios/yaml_document.h"

namespace piperun::scenarios {
namespace {

class YamlWriter : public ParamVisitor {
 public:
  explicit YamlWriter(YAML::Emitter& out) : out_(out) {}

  void Number(const ParamInfo& info, const Range&, double& value) override {
    Key(info);
    out_ << FormatNumber(value);
  }
  void NumberOr(const ParamInfo& info, const Range&, std::string_view none,
                std::optional<double>& value) override {
    Key(info);
    out_ << (value ? FormatNumber(*value) : std::string(none));
  }
  void Integer(const ParamInfo& info, std::int64_t, std::int64_t, std::int64_t& value) override {
    Key(info);
    out_ << value;
  }
  void Flag(const ParamInfo& info, bool& value) override {
    Key(info);
    out_ << (value ? "true" : "false");
  }
  void Text(const ParamInfo& info, std::string& value) override {
    Key(info);
    out_ << YAML::DoubleQuoted << value;
  }
  void Choice(const ParamInfo& info, std::span<const std::string_view>, std::string& value) override {
    Key(info);
    out_ << value;
  }
  void Array(const ParamInfo& info, const Range&, std::span<double> values) override {
    Key(info);
    Row(values);
  }
  void Table(const ParamInfo& info, const Range&, std::size_t columns, std::vector<double>& values) override {
    Key(info);
    out_ << YAML::BeginSeq;
    for (std::size_t i = 0; i < values.size(); i += columns)
      Row(std::span<double>(values).subspan(i, columns));
    out_ << YAML::EndSeq;
  }
  void Group(const ParamInfo& info, const VisitFunction& visit) override {
    Key(info);
    Body(visit);
  }
  void List(const ParamInfo& info, ParamList& list) override {
    Key(info);
    out_ << YAML::BeginSeq;
    for (std::size_t i = 0; i < list.size(); ++i) Body([&](ParamVisitor& v) { list.VisitItem(i, v); });
    out_ << YAML::EndSeq;
  }
  void Map(const ParamInfo& info, ParamMap& map) override {
    Key(info);
    out_ << YAML::BeginMap;
    const std::vector<std::string> names = map.Names();
    for (std::size_t i = 0; i < names.size(); ++i) {
      out_ << YAML::Key << names[i] << YAML::Value;
      Body([&](ParamVisitor& v) { map.VisitItem(i, v); });
    }
    out_ << YAML::EndMap;
  }

  void Body(const VisitFunction& visit) {
    out_ << YAML::BeginMap;
    visit(*this);
    out_ << YAML::EndMap;
  }

 private:
  void Key(const ParamInfo& info) { out_ << YAML::Key << std::string(info.name) << YAML::Value; }
  void Row(std::span<const double> values) {
    out_ << YAML::Flow << YAML::BeginSeq;
    for (const double value : values) out_ << FormatNumber(value);
    out_ << YAML::EndSeq;
  }

  YAML::Emitter& out_;
};

}  // namespace

std::string WriteYaml(const VisitFunction& visit) {
  YAML::Emitter out;
  YamlWriter(out).Body(visit);
  return std::string(out.c_str()) + "\n";
}

}  // namespace piperun::scenarios
