#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace piperun::scenarios {

/// Another spelling of a key: the same quantity in another unit.
struct UnitAlias {
  std::string key;
  double factor;  ///< value in the key's own unit times factor = value in SI
};

/// Spellings accepted for an SI key, by its longest unit suffix: "radius_m" -> radius_mm, radius_cm.
std::vector<UnitAlias> FindUnitAliases(std::string_view si_key);

/// Whether two keys are spellings of one quantity: radius_mm and radius_cm.
bool AreSpellingsOfOne(std::string_view a, std::string_view b);

}  // namespace piperun::scenarios
