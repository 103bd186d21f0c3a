#include "scenarios/material_rules.h"

#include <algorithm>
#include <cctype>

#include "base/check.h"
#include "scenarios/embedded.h"
#include "scenarios/materials.h"
#include "scenarios/yaml_document.h"

namespace piperun::scenarios {
namespace {

constexpr double kLeastIronWall_m = 0.006;  // EN 545:2006

std::string DefaultRules() {
  const auto& files = EmbeddedMaterialRules();
  const auto found =
      std::find_if(files.begin(), files.end(), [](const auto& f) { return f.name == "default"; });
  Demand(found != files.end(), "the default material rules are part of the binary");
  return std::string(found->text);
}

bool HasCondition(const MaterialRule& rule) {
  return rule.tag != "*" || rule.min_diameter_m || rule.max_diameter_m || rule.min_hazen_williams ||
         rule.max_hazen_williams || rule.min_sand_roughness_m || rule.max_sand_roughness_m;
}

int CountWalls(const MaterialRule& rule) {
  return (rule.sdr ? 1 : 0) + (rule.iron_class ? 1 : 0) + (rule.wall_m ? 1 : 0) +
         (rule.wall_classes.empty() ? 0 : 1);
}

/// What is wrong with a rule; empty: nothing.
std::string FindFault(const MaterialRule& rule, bool last) {
  if (CountWalls(rule) != 1) return "give one of sdr, iron_class, wall_m and wall_classes, and only one";
  const auto not_rising = [](const WallClass& a, const WallClass& b) {
    return b.up_to_diameter_m <= a.up_to_diameter_m;
  };
  const auto& classes = rule.wall_classes;
  if (std::adjacent_find(classes.begin(), classes.end(), not_rising) != classes.end()) {
    return "the diameters of wall_classes must rise";
  }
  if (last && HasCondition(rule)) return "the last rule must match every pipe; give it no condition";
  if (!last && !HasCondition(rule)) return "this rule matches every pipe; those behind it would never count";
  return {};
}

bool Within(double value, const std::optional<double>& min, const std::optional<double>& max) {
  return (!min || value >= *min) && (!max || value <= *max);
}

/// A condition on something that the file does not say does not hold.
bool Within(const std::optional<double>& value, const std::optional<double>& min,
            const std::optional<double>& max) {
  if (!min && !max) return true;
  return value && Within(*value, min, max);
}

bool Matches(const MaterialRule& rule, const PipeTraits& pipe) {
  return MatchesGlob(rule.tag, pipe.tag) &&
         Within(pipe.diameter_m, rule.min_diameter_m, rule.max_diameter_m) &&
         Within(pipe.hazen_williams, rule.min_hazen_williams, rule.max_hazen_williams) &&
         Within(pipe.sand_roughness_m, rule.min_sand_roughness_m, rule.max_sand_roughness_m);
}

double CalcWall_m(const MaterialRule& rule, double bore_m) {
  if (rule.wall_m) return *rule.wall_m;
  if (rule.sdr) return bore_m / (*rule.sdr - 2);
  if (rule.iron_class) return std::max(kLeastIronWall_m, *rule.iron_class * (0.5e-3 + 1e-3 * bore_m));
  const auto& classes = rule.wall_classes;
  const auto found = std::find_if(classes.begin(), classes.end(),
                                  [&](const WallClass& c) { return bore_m <= c.up_to_diameter_m; });
  return (found != classes.end() ? *found : classes.back()).wall_m;
}

}  // namespace

bool MatchesGlob(std::string_view glob, std::string_view text) {
  const auto same = [](char a, char b) {
    const auto lower = [](char c) { return std::tolower(static_cast<unsigned char>(c)); };
    return a == '?' || lower(a) == lower(b);
  };
  std::size_t g = 0, t = 0;
  std::optional<std::size_t> star;  // the last one seen, and the text it has taken so far
  std::size_t taken = 0;
  while (t < text.size()) {
    if (g < glob.size() && glob[g] == '*') {
      star = g++;
      taken = t;
    } else if (g < glob.size() && same(glob[g], text[t])) {
      ++g;
      ++t;
    } else if (star) {
      g = *star + 1;
      t = ++taken;
    } else {
      return false;
    }
  }
  return glob.find_first_not_of('*', g) == std::string_view::npos;
}

void WallClass::Visit(ParamVisitor& v) {
  v.Number({"up_to_diameter_m", "Largest bore with this wall.", true}, Range::Positive(), up_to_diameter_m);
  v.Number({"wall_m", "Wall thickness.", true}, {.min = 1e-4, .max = 1}, wall_m);
}

void MaterialRule::Visit(ParamVisitor& v) {
  const std::vector<std::string_view> names = MaterialNames();
  v.Text({"tag", "Tag of the pipe; * stands for any text, ? for one character."}, tag);
  v.NumberOr({"min_diameter_m", "Smallest bore."}, Range::NonNegative(), "any", min_diameter_m);
  v.NumberOr({"max_diameter_m", "Largest bore."}, Range::NonNegative(), "any", max_diameter_m);
  v.NumberOr({"min_hazen_williams", "Smallest C."}, Range::NonNegative(), "any", min_hazen_williams);
  v.NumberOr({"max_hazen_williams", "Largest C."}, Range::NonNegative(), "any", max_hazen_williams);
  v.NumberOr({"min_sand_roughness_m", "Smallest sand roughness."}, Range::NonNegative(), "any",
             min_sand_roughness_m);
  v.NumberOr({"max_sand_roughness_m", "Largest sand roughness."}, Range::NonNegative(), "any",
             max_sand_roughness_m);
  v.Choice({"material", "Wall material, a name from the material library.", true}, names, material);
  v.NumberOr({"sdr", "Outside diameter over wall thickness."}, Range::Between(4, 200), "none", sdr);
  v.NumberOr({"iron_class", "K of EN 545: e = K (0.5 + 0.001 DN) mm, at least 6 mm."}, Range::Between(5, 20),
             "none", iron_class);
  v.NumberOr({"wall_m", "Wall thickness."}, {.min = 1e-4, .max = 1}, "none", wall_m);
  v.Items({"wall_classes", "Wall thickness by bore."}, wall_classes);
}

MaterialRules::MaterialRules() : MaterialRules(DefaultRules(), "assets/materials/rules/default.yaml") {}

MaterialRules::MaterialRules(const std::string& text, const std::string& name) {
  const YamlDocument document(text, name);
  std::string title, description;
  SourceMap sources;
  document.Read(
      [&](ParamVisitor& v) {
        v.Text({"name", "Name of the rules.", true}, title);
        v.Text({"description", "What they are for."}, description);
        v.Items({"rules", "The first that matches counts.", true}, rules_);
      },
      &sources);
  if (rules_.empty()) throw InputError("there is no rule", "rules", sources.Find("rules"));
  for (std::size_t i = 0; i < rules_.size(); ++i) {
    const std::string key = "rules[" + std::to_string(i) + "]";
    const std::string fault = FindFault(rules_[i], i + 1 == rules_.size());
    if (!fault.empty()) throw InputError(fault, key, sources.Find(key));
  }
}

PipeWall MaterialRules::ChooseWall(const PipeTraits& pipe) const {
  const auto rule =
      std::find_if(rules_.begin(), rules_.end(), [&](const MaterialRule& r) { return Matches(r, pipe); });
  Demand(rule != rules_.end(), "the last rule matches every pipe");
  return {rule->material, CalcWall_m(*rule, pipe.diameter_m)};
}

}  // namespace piperun::scenarios
