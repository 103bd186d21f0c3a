#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/params.h"

namespace piperun::scenarios {

/// A wall thickness for bores up to a size.
struct WallClass {
  double up_to_diameter_m = 0;
  double wall_m = 0;
  void Visit(ParamVisitor& v);
};

/// Which wall a pipe is given of which only bore, roughness and tag are known. Conditions that are not given
/// always hold; exactly one of the four ways to state the thickness is given.
struct MaterialRule {
  std::string tag = "*";  ///< glob: '*' any text, '?' one character, case does not matter
  std::optional<double> min_diameter_m, max_diameter_m;
  std::optional<double> min_hazen_williams, max_hazen_williams;
  std::optional<double> min_sand_roughness_m, max_sand_roughness_m;
  std::string material = "ductile_iron";
  std::optional<double> sdr;         ///< e = bore / (SDR - 2)
  std::optional<double> iron_class;  ///< e = K (0.5 + 0.001 DN) mm >= 6 mm (EN 545)
  std::optional<double> wall_m;
  std::vector<WallClass> wall_classes;
  void Visit(ParamVisitor& v);
};

/// What is known of a pipe.
struct PipeTraits {
  std::string_view tag;
  double diameter_m = 0;                   ///< bore
  std::optional<double> hazen_williams;    ///< C, in files with this law
  std::optional<double> sand_roughness_m;  ///< in files with the Darcy-Weisbach law
};

struct PipeWall {
  std::string material;
  double thickness_m = 0;
};

/// Rules in order; the first that matches counts, and the last matches every pipe.
class MaterialRules {
 public:
  /// The default: assets/materials/rules/default.yaml, part of the binary.
  MaterialRules();
  /// Reads a rule file's text; `name` stands in messages. Throws InputError with file and line for what
  /// cannot be read, and for a rule that states no thickness or two, bores of wall classes that do not rise,
  /// a last rule with a condition, or a rule behind one without.
  MaterialRules(const std::string& text, const std::string& name);

  PipeWall ChooseWall(const PipeTraits& pipe) const;

 private:
  std::vector<MaterialRule> rules_;
};

/// Whether a text matches a glob: '*' any text, '?' one character, case does not matter (ASCII).
bool MatchesGlob(std::string_view glob, std::string_view text);

}  // namespace piperun::scenarios
