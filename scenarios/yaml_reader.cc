// The reading half of YamlDocument: a ParamVisitor over a YAML map.

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <charconv>

#include "base/check.h"
#include "base/nearest_name.h"
#include "base/number.h"
#include "scenarios/key_path.h"
#include "scenarios/output_file.h"
#include "scenarios/unit_alias.h"
#include "scenarios/yaml_document.h"

namespace piperun::scenarios {
namespace {

std::string Child(const std::string& path, std::string_view key) {
  return path.empty() ? std::string(key) : path + "." + std::string(key);
}

std::string Item(const std::string& path, std::size_t i) { return path + "[" + std::to_string(i) + "]"; }

/// Marks a value that came from the command line instead of the file.
constexpr char kOverrideTag[] = "!set";

/// What one file's readers share.
struct ReadContext {
  std::string file;
  SourceMap* sources = nullptr;

  std::string Where(const YAML::Node& node) const {
    if (node.Tag() == kOverrideTag) return "--set";
    const YAML::Mark mark = node.Mark();
    return mark.is_null() ? file : file + ":" + std::to_string(mark.line + 1);
  }
  [[noreturn]] void Refuse(const YAML::Node& node, const std::string& path,
                           const std::string& problem) const {
    throw InputError(problem, path, Where(node));
  }
};

std::string Describe(const YAML::Node& node) {
  if (node.IsScalar()) return "'" + node.Scalar() + "'";
  if (node.IsSequence()) return "a list";
  if (node.IsMap()) return "a map";
  return "nothing";
}

/// Reads the fields of one map; Done() refuses what nobody asked for.
class MapReader : public ParamVisitor {
 public:
  MapReader(const ReadContext& context, YAML::Node node, std::string path)
      : context_(context), node_(std::move(node)), path_(std::move(path)) {
    if (!node_.IsMap()) context_.Refuse(node_, path_, "expected a map of keys, found " + Describe(node_));
    for (const auto& entry : node_) {
      const std::string key = entry.first.Scalar();
      const bool twice =
          std::any_of(entries_.begin(), entries_.end(), [&](const Entry& e) { return e.key == key; });
      if (twice) context_.Refuse(entry.first, Child(path_, key), "this key is given twice");
      entries_.push_back({key, entry.first, entry.second, false});
    }
  }

  void Done() const {
    for (const Entry& entry : entries_) {
      if (entry.used) continue;
      std::string problem = "unknown key";
      if (const auto near = FindNearestName(entry.key, known_)) problem += "; did you mean '" + *near + "'?";
      context_.Refuse(entry.key_node, Child(path_, entry.key), problem);
    }
  }

  void Number(const ParamInfo& info, const Range& range, double& value) override {
    const Found found = Find(info, true);
    if (found.entry) value = ReadNumber(found, found.entry->value, found.path, range);
  }

  void NumberOr(const ParamInfo& info, const Range& range, std::string_view none,
                std::optional<double>& value) override {
    const Found found = Find(info, true);
    if (!found.entry) return;
    if (found.entry->value.IsScalar() && found.entry->value.Scalar() == none) {
      value.reset();
    } else {
      value =
          ReadNumber(found, found.entry->value, found.path, range, "a number or '" + std::string(none) + "'");
    }
  }

  void Integer(const ParamInfo& info, std::int64_t min, std::int64_t max, std::int64_t& value) override {
    const Found found = Find(info);
    if (!found.entry) return;
    const std::string text = ReadScalar(found, "a whole number");
    std::int64_t parsed = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), parsed);
    if (error != std::errc{} || end != text.data() + text.size()) Mistyped(found, "a whole number");
    if (parsed < min || parsed > max) {
      context_.Refuse(
          found.entry->value, found.path,
          text + " is out of range; allowed: " + std::to_string(min) + " to " + std::to_string(max));
    }
    value = parsed;
  }

  void Flag(const ParamInfo& info, bool& value) override {
    const Found found = Find(info);
    if (!found.entry) return;
    const std::string text = ReadScalar(found, "true or false");
    if (text != "true" && text != "false") Mistyped(found, "true or false");
    value = text == "true";
  }

  void Text(const ParamInfo& info, std::string& value) override {
    const Found found = Find(info);
    if (found.entry) value = ReadScalar(found, "a text");
  }

  void Choice(const ParamInfo& info, std::span<const std::string_view> allowed, std::string& value) override {
    const Found found = Find(info);
    if (!found.entry) return;
    const std::string text = ReadScalar(found, "a name");
    if (std::find(allowed.begin(), allowed.end(), text) == allowed.end()) {
      std::string problem = "'" + text + "' is not known; ";
      const auto near = FindNearestName(text, {allowed.begin(), allowed.end()});
      if (near) problem += "did you mean '" + *near + "'? ";
      problem += "allowed:";
      for (const std::string_view name : allowed) problem += " " + std::string(name);
      context_.Refuse(found.entry->value, found.path, problem);
    }
    value = text;
  }

  void Array(const ParamInfo& info, const Range& range, std::span<double> values) override {
    const Found found = Find(info, true);
    if (found.entry) ReadRow(found, found.entry->value, found.path, range, values);
  }

  void Table(const ParamInfo& info, const Range& range, std::size_t columns,
             std::vector<double>& values) override {
    const Found found = Find(info, true);
    if (!found.entry) return;
    RequireList(found.entry->value, found.path);
    values.assign(found.entry->value.size() * columns, 0);
    for (std::size_t i = 0; i < found.entry->value.size(); ++i) {
      ReadRow(found, found.entry->value[i], Item(found.path, i), range,
              std::span<double>(values).subspan(i * columns, columns));
    }
  }

  void Group(const ParamInfo& info, const VisitFunction& visit) override {
    const Found found = Find(info);
    if (found.entry) ReadMap(found.entry->value, found.path, visit);
  }

  void List(const ParamInfo& info, ParamList& list) override {
    const Found found = Find(info);
    if (!found.entry) return;
    RequireList(found.entry->value, found.path);
    list.Resize(0);
    list.Resize(found.entry->value.size());
    for (std::size_t i = 0; i < list.size(); ++i) {
      ReadMap(found.entry->value[i], Item(found.path, i), [&](ParamVisitor& v) { list.VisitItem(i, v); });
    }
  }

  void Map(const ParamInfo& info, ParamMap& map) override {
    const Found found = Find(info);
    if (!found.entry) return;
    map.Clear();
    ReadMap(found.entry->value, found.path, [&](ParamVisitor& v) {
      for (const auto& entry : found.entry->value) {
        const std::string name = entry.first.Scalar();
        RequireName(entry.first, Child(found.path, name), name);
        const std::size_t i = map.Names().size();
        map.Add(name);
        v.Group({name, ""}, [&](ParamVisitor& item) { map.VisitItem(i, item); });
      }
    });
  }

 private:
  struct Entry {
    std::string key;
    YAML::Node key_node;
    YAML::Node value;
    bool used;
  };
  /// A key as it was found: under its own name, or under a spelling with another unit.
  struct Found {
    Entry* entry = nullptr;
    std::string path;
    double factor = 1;
  };

  Found Find(const ParamInfo& info, bool with_units = false) {
    std::vector<UnitAlias> spellings;
    if (with_units) spellings = FindUnitAliases(info.name);
    spellings.insert(spellings.begin(), {std::string(info.name), 1});
    Found found;
    for (const UnitAlias& spelling : spellings) {
      known_.push_back(spelling.key);
      const auto entry = std::find_if(entries_.begin(), entries_.end(),
                                      [&](const Entry& e) { return e.key == spelling.key; });
      if (entry == entries_.end()) continue;
      const std::string path = Child(path_, spelling.key);
      if (found.entry)
        context_.Refuse(entry->key_node, path,
                        "the same value is already given as '" + found.entry->key + "'");
      entry->used = true;
      found = {&*entry, path, spelling.factor};
    }
    if (found.entry) {
      Remember(Child(path_, info.name), found.entry->key_node);
    } else if (info.required) {
      RefuseMissing(info, spellings);
    }
    return found;
  }

  /// A required key that is missing was perhaps only misspelt.
  [[noreturn]] void RefuseMissing(const ParamInfo& info, const std::vector<UnitAlias>& spellings) const {
    std::vector<std::string> names;
    for (const UnitAlias& spelling : spellings) names.push_back(spelling.key);
    for (const Entry& entry : entries_) {
      if (entry.used) continue;
      if (const auto near = FindNearestName(entry.key, names)) {
        context_.Refuse(entry.key_node, Child(path_, entry.key),
                        "unknown key; did you mean '" + *near + "'?");
      }
    }
    context_.Refuse(node_, path_,
                    "the key '" + std::string(info.name) + "' is missing: " + std::string(info.doc));
  }

  void Remember(const std::string& path, const YAML::Node& node) const {
    if (context_.sources) context_.sources->Add(path, context_.Where(node));
  }

  [[noreturn]] void Mistyped(const Found& found, const std::string& expected) const {
    context_.Refuse(found.entry->value, found.path,
                    "expected " + expected + ", found " + Describe(found.entry->value));
  }

  std::string ReadScalar(const Found& found, const std::string& expected) const {
    if (!found.entry->value.IsScalar()) Mistyped(found, expected);
    return found.entry->value.Scalar();
  }

  double ReadNumber(const Found& found, const YAML::Node& node, const std::string& path, const Range& range,
                    const std::string& expected = "a number") const {
    const auto number = node.IsScalar() ? ParseNumber(node.Scalar()) : std::nullopt;
    if (!number) context_.Refuse(node, path, "expected " + expected + ", found " + Describe(node));
    const double value = *number * found.factor;
    if (!range.Contains(value)) {
      std::string problem = node.Scalar() + " is out of range; allowed: " + range.Text();
      if (found.factor != 1) problem += " (in SI, where this is " + FormatNumber(value) + ")";
      context_.Refuse(node, path, problem);
    }
    return value;
  }

  void ReadRow(const Found& found, const YAML::Node& node, const std::string& path, const Range& range,
               std::span<double> values) const {
    if (!node.IsSequence() || node.size() != values.size()) {
      context_.Refuse(node, path,
                      "expected a list of " + std::to_string(values.size()) + " numbers, found " +
                          (node.IsSequence() ? std::to_string(node.size()) : Describe(node)));
    }
    for (std::size_t i = 0; i < values.size(); ++i)
      values[i] = ReadNumber(found, node[i], Item(path, i), range);
  }

  void ReadMap(const YAML::Node& node, const std::string& path, const VisitFunction& visit) const {
    MapReader reader(context_, node, path);
    Remember(path, node);
    try {
      visit(reader);
    } catch (const InputError& e) {  // a struct that refuses its own values cannot know where they stand
      if (!e.where().empty()) throw;
      context_.Refuse(reader.FindNode(e.key_path()), Child(path, e.key_path()), e.problem());
    }
    reader.Done();
  }

  /// The value of a key, or the whole map where there is no such key.
  YAML::Node FindNode(const std::string& key) const {
    const auto entry =
        std::find_if(entries_.begin(), entries_.end(), [&](const Entry& e) { return e.key == key; });
    return entry == entries_.end() ? node_ : entry->value;
  }

  void RequireList(const YAML::Node& node, const std::string& path) const {
    if (!node.IsSequence()) context_.Refuse(node, path, "expected a list, found " + Describe(node));
  }

  /// Names become folders and table heads: letters, digits, '_' and '-'.
  void RequireName(const YAML::Node& node, const std::string& path, const std::string& name) const {
    const bool plain = !name.empty() && std::all_of(name.begin(), name.end(), [](unsigned char c) {
      return std::isalnum(c) || c == '_' || c == '-';
    });
    if (!plain) context_.Refuse(node, path, "a name is made of letters, digits, '_' and '-'");
  }

  const ReadContext& context_;
  YAML::Node node_;
  std::string path_;
  std::vector<Entry> entries_;
  std::vector<std::string> known_;
};

YAML::Node Descend(const YAML::Node& parent, const KeyStep& step, const std::string& path) {
  if (step.index) {
    if (!parent.IsSequence() || *step.index >= parent.size()) throw InputError("there is no such item", path);
    return parent[*step.index];
  }
  if (parent.IsSequence()) {
    for (const YAML::Node& item : parent) {
      if (item.IsMap() && item["id"] && item["id"].IsScalar() && item["id"].Scalar() == step.key) return item;
    }
    throw InputError("there is no item with id '" + step.key + "'", path);
  }
  if (parent.IsScalar()) throw InputError("'" + step.key + "' is inside a plain value", path);
  return YAML::Node(parent)[step.key];
}

/// An override replaces the file's value in whatever unit that is given.
void DropOtherSpellings(YAML::Node map, const std::string& key) {
  std::vector<std::string> others;
  for (const auto& entry : map) {
    const std::string name = entry.first.Scalar();
    if (name != key && AreSpellingsOfOne(name, key)) others.push_back(name);
  }
  for (const std::string& name : others) map.remove(name);
}

}  // namespace

struct YamlDocument::Impl {
  std::string name;
  YAML::Node root;
};

YamlDocument::YamlDocument(const std::string& text, std::string name) : impl_(std::make_unique<Impl>()) {
  impl_->name = std::move(name);
  try {
    const std::vector<YAML::Node> documents = YAML::LoadAll(text);
    if (documents.empty()) throw InputError("this file is empty", "", impl_->name);
    if (documents.size() > 1)
      throw InputError("this file holds more than one YAML document", "", impl_->name);
    impl_->root = documents.front();
  } catch (const YAML::Exception& e) {
    const std::string line = e.mark.is_null() ? "" : ":" + std::to_string(e.mark.line + 1);
    throw InputError("this is not YAML: " + e.msg, "", impl_->name + line);
  }
  if (!impl_->root.IsMap()) throw InputError("this is not a YAML map of keys", "", impl_->name);
}

YamlDocument YamlDocument::FromFile(const std::string& path) {
  return YamlDocument(ReadTextFile(path), path);
}

YamlDocument::~YamlDocument() = default;
YamlDocument::YamlDocument(YamlDocument&&) noexcept = default;
YamlDocument& YamlDocument::operator=(YamlDocument&&) noexcept = default;

void YamlDocument::Set(const std::string& assignment) {
  const std::size_t equals = assignment.find('=');
  if (equals == std::string::npos || equals == 0) {
    throw InputError("'" + assignment + "' is not of the form key=value", "--set");
  }
  const std::string path = assignment.substr(0, equals);
  YAML::Node value;
  try {
    value = YAML::Load(assignment.substr(equals + 1));
  } catch (const YAML::Exception& e) {
    throw InputError("the value is not YAML: " + e.msg, path, "--set");
  }
  value.SetTag(kOverrideTag);
  YAML::Node node = impl_->root;
  YAML::Node parent;
  const std::vector<KeyStep> steps = SplitKeyPath(path);
  for (const KeyStep& step : steps) {
    parent.reset(node);
    node.reset(Descend(node, step, path));
  }
  node = value;
  if (parent.IsMap()) DropOtherSpellings(parent, steps.back().key);
}

void YamlDocument::Read(const VisitFunction& visit, SourceMap* sources) const {
  const ReadContext context{impl_->name, sources};
  MapReader reader(context, impl_->root, "");
  visit(reader);
  reader.Done();
}

void YamlDocument::ReadSome(const VisitFunction& visit) const {
  const ReadContext context{impl_->name};
  MapReader reader(context, impl_->root, "");
  visit(reader);
}

std::string SourceMap::Find(std::string key_path) const {
  while (true) {
    const auto found = where_.find(key_path);
    if (found != where_.end()) return found->second;
    const std::size_t cut = key_path.find_last_of(".[");
    if (cut == std::string::npos) return {};
    key_path.resize(cut);
  }
}

}  // namespace piperun::scenarios
