#include "scenarios/unit_alias.h"

#include <algorithm>
#include <iterator>
#include <numbers>

namespace piperun::scenarios {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kStandardGravity = 9.80665;

struct Spelling {
  std::string_view si;
  std::string_view other;
  double factor;
};

// Longer SI suffixes stand before the shorter ones they end in; those that are no plain unit have no other
// spelling.
constexpr Spelling kSpellings[] = {
    {"_rad_s_per_m2_s4", "_deg_h_per_g2", kDegree / 3600 / (kStandardGravity * kStandardGravity)},
    {"_m_s2_per_m2_s4", "_ug_per_g2", 1e-6 / kStandardGravity},
    {"_rad_s_per_m_s2", "_deg_s_per_g", kDegree / kStandardGravity},
    {"_rad_s_per_m_s2", "_deg_h_per_g", kDegree / 3600 / kStandardGravity},
    {"_rad_s_per_K", "_deg_s_per_K", kDegree},
    {"_m_s2_per_K", "_mg_per_K", 1e-3 * kStandardGravity},
    {"_per_rad_s", "_per_deg_s", 1 / kDegree},
    {"_per_m_s2", "_per_g", 1 / kStandardGravity},
    {"_dB_m", "", 1},
    {"_N_s_m", "", 1},
    {"_N_m", "", 1},
    {"_s_m_rad", "", 1},
    {"_rad_s2_sqrtHz", "_deg_s2_sqrtHz", kDegree},
    {"_rad_s_sqrtHz", "_deg_s_sqrtHz", kDegree},
    {"_m_s2_sqrtHz", "_ug_sqrtHz", 1e-6 * kStandardGravity},
    {"_rad_s2", "_deg_s2", kDegree},
    {"_rad_s", "_deg_s", kDegree},
    {"_rad_s", "_deg_h", kDegree / 3600},
    {"_m_s2", "_mg", 1e-3 * kStandardGravity},
    {"_m_s2", "_ug", 1e-6 * kStandardGravity},
    {"_m3_s", "_L_s", 1e-3},
    {"_m3_s", "_L_min", 1e-3 / 60},
    {"_m3_s", "_m3_h", 1.0 / 3600},
    {"_m_s", "", 1},
    {"_rad", "_deg", kDegree},
    {"_s", "_min", 60},
    {"_s", "_h", 3600},
    {"_Pa", "_bar", 1e5},
    {"_Pa", "_kPa", 1e3},
    {"_T", "_uT", 1e-6},
    {"_m", "_mm", 1e-3},
    {"_m", "_cm", 1e-2},
};

}  // namespace

std::vector<UnitAlias> FindUnitAliases(std::string_view si_key) {
  std::vector<UnitAlias> aliases;
  std::string_view suffix;
  for (const Spelling& spelling : kSpellings) {
    if (!si_key.ends_with(spelling.si) || (!suffix.empty() && spelling.si != suffix)) continue;
    suffix = spelling.si;
    if (spelling.other.empty()) continue;
    const std::string_view stem = si_key.substr(0, si_key.size() - suffix.size());
    aliases.push_back({std::string(stem) + std::string(spelling.other), spelling.factor});
  }
  return aliases;
}

bool AreSpellingsOfOne(std::string_view a, std::string_view b) {
  const auto spells = [](std::string_view si_key, std::string_view key) {
    const auto aliases = FindUnitAliases(si_key);
    return si_key == key || std::any_of(aliases.begin(), aliases.end(),
                                        [&](const UnitAlias& alias) { return alias.key == key; });
  };
  if (spells(a, b) || spells(b, a)) return true;
  return std::any_of(std::begin(kSpellings), std::end(kSpellings), [&](const Spelling& s) {
    if (s.other.empty() || !a.ends_with(s.other)) return false;
    const std::string si_key = std::string(a.substr(0, a.size() - s.other.size())) + std::string(s.si);
    return spells(si_key, a) && spells(si_key, b);
  });
}

}  // namespace piperun::scenarios
