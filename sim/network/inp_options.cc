#include <array>
#include <string>

#include "sim/network/epanet_constants.h"
#include "sim/network/inp_draft.h"

namespace piperun::sim {
namespace {

using epanet::kCubicFoot_m3;
using epanet::kFoot_m;

struct FlowUnit {
  const char* name;
  double per_cubic_foot_second;  ///< EPANET's own factor
  bool metric;
};
constexpr std::array<FlowUnit, 12> kFlowUnits{{{"CFS", 1, false},
                                               {"GPM", 448.831, false},
                                               {"MGD", 0.64632, false},
                                               {"IMGD", 0.5382, false},
                                               {"AFD", 1.9837, false},
                                               {"LPS", 28.317, true},
                                               {"LPM", 1699.0, true},
                                               {"MLD", 2.4466, true},
                                               {"CMH", 101.94, true},
                                               {"CMD", 2446.6, true},
                                               {"CMS", 0.028317, true},
                                               {"SI", 28.317, true}}};

struct PressureUnit {
  const char* name;
  double per_foot;
  bool weighs;  ///< a pressure proper: grows with the specific gravity; a column of the liquid does not
};
constexpr double kPsiPerFoot = 0.4333;
constexpr std::array<PressureUnit, 5> kPressureUnits{{{"PSI", kPsiPerFoot, true},
                                                      {"KPA", 6.895 * kPsiPerFoot, true},
                                                      {"METERS", kFoot_m, false},
                                                      {"BAR", 0.068948 * kPsiPerFoot, true},
                                                      {"FEET", 1, false}}};

template <class Table>
const auto& FindUnit(const InpLine& line, const Table& table) {
  line.RequireWords(2, "KEYWORD unit");
  std::string known;
  for (const auto& unit : table) {
    if (BeginsWith(line[1], unit.name)) return unit;
    if (!known.empty()) known += ", ";
    known += unit.name;
  }
  line.Fail("the unit '" + line[1] + "' is unknown; allowed: " + known);
}

HeadLossLaw ReadLaw(const InpLine& line) {
  line.RequireWords(2, "HEADLOSS H-W|D-W|C-M");
  if (BeginsWith(line[1], "H-W")) return HeadLossLaw::kHazenWilliams;
  if (BeginsWith(line[1], "D-W")) return HeadLossLaw::kDarcyWeisbach;
  if (BeginsWith(line[1], "C-M")) return HeadLossLaw::kChezyManning;
  line.Fail("the head loss law '" + line[1] + "' is unknown; allowed: H-W, D-W, C-M");
}

bool ReadYesNo(const InpLine& line, std::size_t word) {
  line.RequireWords(word + 1, "YES|NO");
  if (BeginsWith(line[word], "YES")) return true;
  if (BeginsWith(line[word], "NO")) return false;
  line.Fail("'" + line[word] + "' must be YES or NO");
}

/// What options mean before units are known: values as the file has them.
struct RawOptions {
  const FlowUnit* flow = &kFlowUnits[1];
  const PressureUnit* pressure = nullptr;
  double viscosity = 1;  ///< a multiple of water's when > 1e-3, else a viscosity in the file's units
  double head_error = 0;
  double flow_change = 0;
  double min_pressure = 0;
  double required_pressure = 0.1;
  const InpLine* required_line = nullptr;
  std::string default_pattern = "1";
  const InpLine* pattern_line = nullptr;
};

void ReadUnbalanced(const InpLine& line, HydraulicOptions& options) {
  line.RequireWords(2, "UNBALANCED STOP|CONTINUE trials");
  if (BeginsWith(line[1], "STOP")) {
    options.extra_trials = -1;
  } else if (BeginsWith(line[1], "CONT")) {
    options.extra_trials =
        line.size() > 2 ? static_cast<int>(ReadNumber(line, 2, "trials", Range::Between(0, 1e6))) : 0;
  } else {
    line.Fail("'" + line[1] + "' must be STOP or CONTINUE");
  }
}

void ReadDemandOption(const InpLine& line, HydraulicOptions& options) {
  line.RequireWords(3, "DEMAND MULTIPLIER value, or DEMAND MODEL DDA|PDA");
  if (!BeginsWith(line[1], "MODEL")) {
    options.demand_multiplier = ReadNumber(line, 2, "demand multiplier", Range::Positive());
  } else if (BeginsWith(line[2], "PDA")) {
    options.pressure_driven = true;
  } else if (BeginsWith(line[2], "DDA")) {
    options.pressure_driven = false;
  } else {
    line.Fail("the demand model '" + line[2] + "' is unknown; allowed: DDA, PDA");
  }
}

/// Options with a name, or with a meaning of their own. False: not one of these.
bool ReadChoice(const InpLine& line, RawOptions& raw, HydraulicModel& model) {
  HydraulicOptions& options = model.options;
  const std::string& key = line[0];
  if (BeginsWith(key, "UNIT")) {
    raw.flow = &FindUnit(line, kFlowUnits);
  } else if (BeginsWith(key, "PRESSURE") && line.size() > 1 && !BeginsWith(line[1], "EXP")) {
    raw.pressure = &FindUnit(line, kPressureUnits);
  } else if (BeginsWith(key, "HEADL")) {
    options.law = ReadLaw(line);
  } else if (BeginsWith(key, "UNBA")) {
    ReadUnbalanced(line, options);
  } else if (BeginsWith(key, "PATT")) {
    line.RequireWords(2, "PATTERN id");
    raw.default_pattern = line[1];
    raw.pattern_line = &line;
  } else if (BeginsWith(key, "DEMAND")) {
    ReadDemandOption(line, options);
  } else if (BeginsWith(key, "BACK")) {
    options.emitter_backflow = ReadYesNo(line, 2);
  } else if (BeginsWith(key, "HYDR")) {
    line.Fail("HYDRAULICS USE/SAVE files are not supported; remove the line: the hydraulics are solved here");
  } else {
    return false;
  }
  return true;
}

/// Options of water quality and of EPANET's own screens.
bool IsForeign(const std::string& key) {
  constexpr std::array<const char*, 6> kForeign{"QUAL", "DIFF", "TOLER", "MAP", "VERI", "SEGM"};
  for (const char* word : kForeign) {
    if (BeginsWith(key, word)) return true;
  }
  return false;
}

int ReadCount(const InpLine& line, const char* what) {
  return static_cast<int>(ReadNumber(line, 1, what, Range::Between(1, 1e6)));
}

bool ReadTolerance(const InpLine& line, RawOptions& raw, HydraulicOptions& options) {
  const std::string& key = line[0];
  if (BeginsWith(key, "TRIAL")) {
    options.max_trials = ReadCount(line, "trials");
  } else if (BeginsWith(key, "ACCU")) {
    options.accuracy = ReadNumber(line, 1, "accuracy", {.min = 0, .max = 0.1, .min_open = true});
  } else if (BeginsWith(key, "HEADERROR")) {
    raw.head_error = ReadNumber(line, 1, "head error", Range::NonNegative());
  } else if (BeginsWith(key, "FLOWCHANGE")) {
    raw.flow_change = ReadNumber(line, 1, "flow change", Range::NonNegative());
  } else if (BeginsWith(key, "HTOL")) {
    options.head_tolerance_m = kFoot_m * ReadNumber(line, 1, "HTOL", Range::Positive());
  } else if (BeginsWith(key, "QTOL")) {
    options.flow_tolerance_m3_s = kCubicFoot_m3 * ReadNumber(line, 1, "QTOL", Range::Positive());
  } else if (BeginsWith(key, "RQTOL")) {
    options.least_slope_s_m2 =
        ReadNumber(line, 1, "RQTOL", {.min = 0, .max = 1, .min_open = true}) / epanet::kSquareFoot_m2;
  } else if (BeginsWith(key, "CHECKFREQ")) {
    options.check_frequency = ReadCount(line, "CHECKFREQ");
  } else if (BeginsWith(key, "MAXCHECK")) {
    options.max_check = ReadCount(line, "MAXCHECK");
  } else if (BeginsWith(key, "DAMPLIMIT")) {
    options.damp_limit = ReadNumber(line, 1, "DAMPLIMIT", Range::NonNegative());
  } else {
    return false;
  }
  return true;
}

void ReadPhysics(const InpLine& line, RawOptions& raw, HydraulicOptions& options) {
  const std::string& key = line[0];
  if (BeginsWith(key, "VISC")) {
    raw.viscosity = ReadNumber(line, 1, "viscosity", Range::Positive());
  } else if (BeginsWith(key, "SPEC")) {
    options.specific_gravity = ReadNumber(line, 2, "specific gravity", Range::Positive());
  } else if (BeginsWith(key, "EMIT")) {
    options.emitter_exponent = ReadNumber(line, 2, "emitter exponent", Range::Positive());
  } else if (BeginsWith(key, "MINI")) {
    raw.min_pressure = ReadNumber(line, 2, "minimum pressure", Range::NonNegative());
  } else if (BeginsWith(key, "REQ")) {
    raw.required_pressure = ReadNumber(line, 2, "required pressure", Range::Positive());
    raw.required_line = &line;
  } else if (BeginsWith(key, "PRESSURE")) {
    options.pressure_exponent = ReadNumber(line, 2, "pressure exponent", Range::Positive());
  } else {
    line.Fail(
        "unknown option; known are UNITS, PRESSURE, HEADLOSS, VISCOSITY, SPECIFIC GRAVITY, TRIALS, "
        "ACCURACY, UNBALANCED, PATTERN, DEMAND MULTIPLIER, EMITTER EXPONENT and those of EPANET 2.3");
  }
}

double CalcPressureUnit(const PressureUnit& unit, double specific_gravity) {
  return kFoot_m / (unit.per_foot * (unit.weighs ? specific_gravity : 1));
}

InpUnits MakeUnits(const RawOptions& raw, double specific_gravity) {
  const PressureUnit& usual = kPressureUnits[raw.flow->metric ? 2 : 0];
  InpUnits units;
  units.length_m = raw.flow->metric ? 1 : kFoot_m;
  units.diameter_m = raw.flow->metric ? 1e-3 : kFoot_m / 12;
  units.roughness_m = 1e-3 * units.length_m;
  units.flow_m3_s = kCubicFoot_m3 / raw.flow->per_cubic_foot_second;
  units.pressure_m = CalcPressureUnit(raw.pressure ? *raw.pressure : usual, specific_gravity);
  units.emitter_pressure_m = CalcPressureUnit(usual, specific_gravity);
  units.power_W = raw.flow->metric ? 1000 : epanet::kHorsepower_W;
  return units;
}

/// Turns what depended on units into SI.
void Convert(const RawOptions& raw, const InpUnits& units, HydraulicOptions& options) {
  options.flow_unit = raw.flow->name;
  options.metric = raw.flow->metric;
  options.flow_unit_m3_s = units.flow_m3_s;
  options.pressure_unit_m = units.pressure_m;
  options.viscosity_m2_s = raw.viscosity > 1e-3 ? raw.viscosity * epanet::kViscosity_m2_s
                                                : raw.viscosity * units.length_m * units.length_m;
  options.head_error_m = raw.head_error * units.length_m;
  options.flow_change_m3_s = raw.flow_change * units.flow_m3_s;
  options.min_pressure_m = raw.min_pressure * units.pressure_m;
  const double required = raw.required_line ? raw.required_pressure : raw.min_pressure + 0.1;
  if (required - raw.min_pressure < 0.1 - 1e-12) {
    raw.required_line->Fail("the required pressure must be at least 0.1 above the minimum pressure");
  }
  options.required_pressure_m = required * units.pressure_m;
}

}  // namespace

void ReadOptions(const InpSections& sections, InpDraft& draft) {
  HydraulicOptions& options = draft.model.options;
  options.head_tolerance_m = 5e-4 * kFoot_m;
  options.flow_tolerance_m3_s = 1e-4 * kCubicFoot_m3;
  options.least_slope_s_m2 = 1e-7 / epanet::kSquareFoot_m2;
  RawOptions raw;
  for (const InpLine& line : Lines(sections, InpSection::kOptions)) {
    if (IsForeign(line[0])) {
      draft.model.notes.push_back("[OPTIONS] " + line[0] + ": no matter for hydraulics, not read");
    } else if (!ReadChoice(line, raw, draft.model) && !ReadTolerance(line, raw, options)) {
      ReadPhysics(line, raw, options);
    }
  }
  draft.units = MakeUnits(raw, options.specific_gravity);
  Convert(raw, draft.units, options);
  draft.default_pattern_id = raw.default_pattern;
  draft.default_pattern_line = raw.pattern_line;
}

}  // namespace piperun::sim
