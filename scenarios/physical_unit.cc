#include "scenarios/physical_unit.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

#include "base/check.h"
#include "base/nearest_name.h"
#include "base/number.h"

namespace piperun::scenarios {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kGravity_m_s2 = 9.80665;
constexpr double kPsi_Pa = 0.45359237 * kGravity_m_s2 / (0.0254 * 0.0254);  // pound-force to the square inch

struct NamedUnit {
  std::string_view name;
  PhysicalUnit unit;
};

// Exponents: rad, m, s, T, Pa, K.
const NamedUnit kUnits[] = {
    {"1", {}},
    {"%", {1e-2, {}}},
    {"ppm", {1e-6, {}}},
    {"rad", {1, {1}}},
    {"mrad", {1e-3, {1}}},
    {"urad", {1e-6, {1}}},
    {"deg", {kDegree, {1}}},
    {"mdeg", {1e-3 * kDegree, {1}}},
    {"arcmin", {kDegree / 60, {1}}},
    {"arcsec", {kDegree / 3600, {1}}},
    {"dps", {kDegree, {1, 0, -1}}},
    {"mdps", {1e-3 * kDegree, {1, 0, -1}}},
    {"m", {1, {0, 1}}},
    {"cm", {1e-2, {0, 1}}},
    {"mm", {1e-3, {0, 1}}},
    {"um", {1e-6, {0, 1}}},
    {"g", {kGravity_m_s2, {0, 1, -2}}},
    {"mg", {1e-3 * kGravity_m_s2, {0, 1, -2}}},
    {"ug", {1e-6 * kGravity_m_s2, {0, 1, -2}}},
    {"s", {1, {0, 0, 1}}},
    {"ms", {1e-3, {0, 0, 1}}},
    {"min", {60, {0, 0, 1}}},
    {"h", {3600, {0, 0, 1}}},
    {"hr", {3600, {0, 0, 1}}},
    {"Hz", {1, {0, 0, -1}}},
    {"T", {1, {0, 0, 0, 1}}},
    {"mT", {1e-3, {0, 0, 0, 1}}},
    {"uT", {1e-6, {0, 0, 0, 1}}},
    {"nT", {1e-9, {0, 0, 0, 1}}},
    {"gauss", {1e-4, {0, 0, 0, 1}}},
    {"G", {1e-4, {0, 0, 0, 1}}},
    {"mG", {1e-7, {0, 0, 0, 1}}},
    {"Pa", {1, {0, 0, 0, 0, 1}}},
    {"hPa", {1e2, {0, 0, 0, 0, 1}}},
    {"kPa", {1e3, {0, 0, 0, 0, 1}}},
    {"mbar", {1e2, {0, 0, 0, 0, 1}}},
    {"bar", {1e5, {0, 0, 0, 0, 1}}},
    {"psi", {kPsi_Pa, {0, 0, 0, 0, 1}}},
    {"uPa", {1e-6, {0, 0, 0, 0, 1}}},
    {"K", {1, {0, 0, 0, 0, 0, 1}}},
    {"mK", {1e-3, {0, 0, 0, 0, 0, 1}}},
    // of differences and spreads: a sensor's temperature itself is never converted
    {"degC", {1, {0, 0, 0, 0, 0, 1}}},
};

/// Quantities in SI, each with the units that data sheets give it in.
struct Quantity {
  std::string_view si;
  std::vector<std::string_view> data_sheet;
};
const Quantity kQuantities[] = {
    {"1", {"%", "ppm"}},
    {"rad", {"deg", "arcsec"}},
    {"rad/s", {"deg/h", "deg/s", "mdps"}},
    {"rad/s/sqrt(Hz)", {"deg/sqrt(h)", "deg/s/sqrt(Hz)", "mdps/sqrt(Hz)", "deg/h/sqrt(Hz)"}},
    {"rad/s^2", {"deg/h/h", "deg/s^2"}},
    {"rad/s^2/sqrt(Hz)", {"deg/h/sqrt(h)", "deg/s^2/sqrt(Hz)"}},
    {"m", {"mm"}},
    {"m/s", {"mm/s"}},
    {"m/s^2", {"ug", "mg", "g"}},
    {"m/s^2/sqrt(Hz)", {"ug/sqrt(Hz)", "m/s/sqrt(h)", "mg/sqrt(Hz)"}},
    {"m/s^3", {"ug/h", "mg/h"}},
    {"m/s^3/sqrt(Hz)", {"ug/sqrt(h)", "mg/sqrt(h)"}},
    {"T", {"nT", "uT", "mG"}},
    {"T/sqrt(Hz)", {"nT/sqrt(Hz)"}},
    {"T s", {"nT s"}},
    {"T/s", {"nT/h"}},
    {"T/s/sqrt(Hz)", {"nT/sqrt(h)"}},
    {"Pa", {"hPa", "mbar"}},
    {"Pa/sqrt(Hz)", {"uPa/sqrt(Hz)"}},
    {"Pa s", {}},
    {"Pa/s", {"Pa/h"}},
    {"Pa/s/sqrt(Hz)", {"Pa/sqrt(h)"}},
    {"rad s/m", {"deg/s/g", "deg/h/g"}},
    {"s", {"ms", "h"}},
    {"1/sqrt(Hz)", {"ppm/sqrt(Hz)"}},
    {"Hz", {}},
};

std::string Replaced(std::string text, std::string_view from, std::string_view to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size())) {
    text.replace(at, from.size(), to);
  }
  return text;
}

/// In the letters of the grammar: sqrt, u and deg instead of their signs.
std::string Normalised(std::string_view text) {
  std::string plain(text);
  constexpr std::pair<std::string_view, std::string_view> kSigns[] = {
      {"\xC2\xB5", "u"},  {"\xCE\xBC", "u"},   {"\xC2\xB0", "deg"}, {"\xE2\x88\x9A", "sqrt "},
      {"sqrt(", "sqrt "}, {"rtHz", "sqrt Hz"}, {"rthr", "sqrt h"},  {"rth", "sqrt h"},
      {"(", " "},         {")", " "},          {"*", " "}};
  for (const auto& [sign, letters] : kSigns) plain = Replaced(plain, sign, letters);
  return plain;
}

PhysicalUnit Power(PhysicalUnit unit, double exponent) {
  unit.factor = std::pow(unit.factor, exponent);
  for (double& e : unit.exponents) e *= exponent;
  return unit;
}

PhysicalUnit Product(PhysicalUnit a, const PhysicalUnit& b) {
  a.factor *= b.factor;
  for (std::size_t i = 0; i < a.exponents.size(); ++i) a.exponents[i] += b.exponents[i];
  return a;
}

[[noreturn]] void RefuseUnit(std::string_view name, std::string_view whole, const std::string& key_path) {
  std::vector<std::string> names;
  for (const NamedUnit& known : kUnits) names.emplace_back(known.name);
  const auto near = FindNearestName(std::string(name), names);
  throw InputError("'" + std::string(whole) + "' is not a known unit" +
                       (name == whole ? "" : ": '" + std::string(name) + "' is not") +
                       (near ? "; did you mean '" + *near + "'?" : "") +
                       " (examples: deg/s, rad/s, deg/sqrt(h), g, m/s^2, ug/sqrt(Hz), uT, Pa)",
                   key_path);
}

/// One name with its power: "s", "h^1.5", "s^-2"; also "s2" as some write it.
PhysicalUnit ParseName(std::string_view name, std::string_view whole, const std::string& key_path) {
  const std::size_t caret = name.find('^');
  const std::string_view stem = name.substr(0, caret);
  const auto found =
      std::find_if(std::begin(kUnits), std::end(kUnits), [&](const NamedUnit& u) { return u.name == stem; });
  if (found == std::end(kUnits)) RefuseUnit(stem, whole, key_path);
  if (caret == std::string_view::npos) return found->unit;
  const auto exponent = ParseNumber(name.substr(caret + 1));
  if (!exponent) RefuseUnit(name, whole, key_path);
  return Power(found->unit, *exponent);
}

}  // namespace

PhysicalUnit ParseUnit(std::string_view text, const std::string& key_path) {
  const std::string plain = Normalised(text);
  PhysicalUnit unit;
  double sign = 1, root = 1;
  bool any = false;
  for (std::size_t at = 0; at < plain.size();) {
    if (plain[at] == '/')
      sign = -1, ++at;
    else if (plain[at] == ' ')
      ++at;
    else {
      const std::size_t end = std::min(plain.find_first_of(" /", at), plain.size());
      const std::string_view name = std::string_view(plain).substr(at, end - at);
      at = end;
      if (name == "sqrt") {
        root = 0.5;
        continue;
      }
      unit = Product(unit, Power(ParseName(name, text, key_path), sign * root));
      sign = root = 1;
      any = true;
    }
  }
  if (!any || sign != 1 || root != 1) RefuseUnit(text, text, key_path);
  return unit;
}

std::string SiUnitText(const PhysicalUnit& unit) {
  for (const Quantity& quantity : kQuantities) {
    if (ParseUnit(quantity.si, "").SameDimension(unit)) return std::string(quantity.si);
  }
  constexpr std::string_view kNames[] = {"rad", "m", "s", "T", "Pa", "K"};
  std::string text;
  for (std::size_t i = 0; i < unit.exponents.size(); ++i) {
    if (unit.exponents[i] == 0) continue;
    text += (text.empty() ? "" : " ") + std::string(kNames[i]);
    if (unit.exponents[i] != 1) text += "^" + FormatNumber(unit.exponents[i]);
  }
  return text;
}

std::vector<std::string_view> DataSheetUnits(const PhysicalUnit& unit) {
  for (const Quantity& quantity : kQuantities) {
    if (ParseUnit(quantity.si, "").SameDimension(unit)) return quantity.data_sheet;
  }
  return {};
}

SiValue ConvertToSi(double value, std::string_view unit, const FullScale& scale) {
  double counts = 1;
  PhysicalUnit parsed;
  const bool percent = unit.starts_with("%FS"), lsb = unit.starts_with("LSB");
  if (percent || lsb) {
    if (!scale.range_si)
      throw InputError("'" + std::string(unit) + "' needs the range it refers to", "--range");
    if (lsb && !scale.bits)
      throw InputError("'" + std::string(unit) + "' needs the bits of the register", "--bits");
    counts = percent ? 0.01 * *scale.range_si : std::ldexp(2 * *scale.range_si, -*scale.bits);
    const std::string rest = scale.range_unit + std::string(unit.substr(3));
    parsed = ParseUnit(rest, "UNIT");
  } else {
    parsed = ParseUnit(unit, "UNIT");
  }
  const double si = value * counts * parsed.factor;
  parsed.factor = 1;
  return {si, parsed};
}

}  // namespace piperun::scenarios
