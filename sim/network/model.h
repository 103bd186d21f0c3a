#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace piperun::sim {

/// A drawing's coordinates, in whatever unit the drawing has.
struct MapPoint {
  double x = 0;
  double y = 0;
};

struct CurvePoint {
  double x = 0;
  double y = 0;
};
using Curve = std::vector<CurvePoint>;  ///< x strictly rising

/// Multipliers, one per pattern step, repeated for ever.
struct Pattern {
  std::string id;
  std::vector<double> multipliers;
};

/// What a junction's customers take: base demand times the multiplier of its pattern (-1: always 1).
struct DemandCategory {
  double base_m3_s = 0;
  int pattern = -1;
  std::string name;
};

/// A hole that grows with pressure (FAVAD: May 1994; van Zyl & Cassa, J. Hydraul. Eng. 140, 04014015, 2014):
/// Q = fixed h^0.5 + variable h^1.5 for pressure head h > 0, and nothing flows in.
struct LeakCoefficients {
  double fixed_m25_s = 0;     ///< Cd sqrt(2 g) A0, m^2.5/s
  double variable_m15_s = 0;  ///< Cd sqrt(2 g) dA/dh, m^1.5/s
};

struct JunctionNode {
  std::string id;
  double elevation_m = 0;
  std::vector<DemandCategory> demands;
  double emitter = 0;  ///< m3/s at a pressure head of 1 m; the exponent is HydraulicOptions::emitter_exponent
  LeakCoefficients leak;
  std::optional<MapPoint> position;
  std::string tag;
};

struct ReservoirNode {
  std::string id;
  double head_m = 0;
  int pattern = -1;
  std::optional<MapPoint> position;
  std::string tag;
};

/// A tank: a cylinder, or any shape given by a curve of volume [m3] over level [m]. Levels count from the
/// elevation of its bottom.
struct TankNode {
  std::string id;
  double elevation_m = 0;
  double initial_level_m = 0;
  double min_level_m = 0;
  double max_level_m = 0;
  double diameter_m = 0;
  double min_volume_m3 = 0;
  Curve volume_curve;
  bool can_overflow = false;
  std::optional<MapPoint> position;
  std::string tag;
};

/// Closed for one of three reasons, or open in one of four ways; the order matters: up to kClosed is closed.
enum class LinkStatus : std::uint8_t {
  kPumpTooWeak,        ///< the head to overcome is above the pump's shut-off head
  kTemporarilyClosed,  ///< leads into a full tank or out of an empty one
  kClosed,
  kOpen,
  kActive,         ///< a control valve that is controlling
  kFlowShort,      ///< a flow control valve that cannot pass its setting; open
  kPressureShort,  ///< a pressure valve whose setting is out of reach; open
};
inline bool IsClosed(LinkStatus status) { return status <= LinkStatus::kClosed; }
/// "open", "closed", "active".
const char* StatusText(LinkStatus status);

struct PipeLink {
  std::string id;
  int from = 0;
  int to = 0;
  double length_m = 0;
  double diameter_m = 0;
  double roughness = 0;  ///< Hazen-Williams C [], Darcy-Weisbach sand roughness [m], or Manning n []
  double minor_loss = 0;
  LinkStatus status = LinkStatus::kOpen;
  bool check_valve = false;  ///< water passes from `from` to `to` only
  LeakCoefficients leakage;  ///< of the whole pipe; the solver gives half to each end, as EPANET does
  std::vector<MapPoint> vertices;
  std::string tag;
};

enum class PumpKind : std::uint8_t { kPowerFunction, kCurve, kConstantPower };

struct PumpLink {
  std::string id;
  int from = 0;
  int to = 0;
  PumpKind kind = PumpKind::kPowerFunction;
  Curve curve;  ///< head gain [m] over flow [m3/s], falling; as given (one point, three points or more)
  double power_W = 0;  ///< given to the water
  double speed = 1;    ///< relative
  int pattern = -1;    ///< of the speed
  LinkStatus status = LinkStatus::kOpen;
  std::vector<MapPoint> vertices;
  std::string tag;
};

enum class ValveKind : std::uint8_t {
  kPressureReducing,    ///< PRV, setting: pressure head at `to` [m]
  kPressureSustaining,  ///< PSV, setting: pressure head at `from` [m]
  kPressureBreaker,     ///< PBV, setting: head loss [m]
  kFlowControl,         ///< FCV, setting: greatest flow [m3/s]
  kThrottle,            ///< TCV, setting: loss coefficient []
  kGeneralPurpose,      ///< GPV, curve: head loss [m] over flow [m3/s]
  kPositional,  ///< PCV, setting: opening [%], curve: Kv/Kvo [%] over opening [%] (none: proportional)
};

struct ValveLink {
  std::string id;
  int from = 0;
  int to = 0;
  double diameter_m = 0;
  ValveKind kind = ValveKind::kThrottle;
  double setting = 0;
  Curve curve;
  double minor_loss = 0;                    ///< loss coefficient when fully open
  LinkStatus status = LinkStatus::kActive;  ///< kOpen, kClosed: fixed, the setting does not act
  std::vector<MapPoint> vertices;
  std::string tag;
};

/// What a control or rule does to a link: a status, or a setting (pump speed, valve setting in SI).
struct LinkAction {
  int link = 0;
  std::optional<LinkStatus> status;
  std::optional<double> setting;
};

struct SimpleControl {
  enum class When : std::uint8_t { kBelow, kAbove, kTime, kClockTime };
  LinkAction action;
  When when = When::kTime;
  int node = -1;            ///< kBelow, kAbove
  double head_m = 0;        ///< the node's head at which it acts
  std::int64_t time_s = 0;  ///< since the start, or since midnight
  bool enabled = true;
};

struct RulePremise {
  enum class Subject : std::uint8_t { kNode, kLink, kSystem };
  enum class Quantity : std::uint8_t {
    kDemand,
    kHead,
    kPressure,
    kLevel,
    kFlow,
    kStatus,
    kSetting,
    kTime,
    kClockTime,
    kFillTime,
    kDrainTime,
  };
  enum class Relation : std::uint8_t { kEqual, kNotEqual, kLess, kLessOrEqual, kGreater, kGreaterOrEqual };
  bool is_alternative = false;  ///< joined by OR, not AND
  Subject subject = Subject::kSystem;
  int index = -1;  ///< node or link
  Quantity quantity = Quantity::kTime;
  Relation relation = Relation::kEqual;
  double value = 0;                       ///< SI
  double tolerance = 0;                   ///< 0.001 of the file's own unit, in SI: what EPANET calls equal
  LinkStatus status = LinkStatus::kOpen;  ///< for kStatus
};

struct Rule {
  std::string id;
  std::vector<RulePremise> premises;
  std::vector<LinkAction> then_actions;
  std::vector<LinkAction> else_actions;
  double priority = 0;
};

enum class HeadLossLaw : std::uint8_t { kHazenWilliams, kDarcyWeisbach, kChezyManning };

/// Options of the hydraulics. Tolerances are EPANET's, in SI.
struct HydraulicOptions {
  std::string flow_unit = "GPM";
  double flow_unit_m3_s = 0;   ///< what one flow unit of the file is here
  double pressure_unit_m = 0;  ///< metres of head per pressure unit of the file
  bool metric = false;
  HeadLossLaw law = HeadLossLaw::kHazenWilliams;
  double specific_gravity = 1;
  double viscosity_m2_s = 0;
  int max_trials = 200;
  double accuracy = 1e-3;       ///< sum |dQ| / sum |Q| at which iterations end
  double head_error_m = 0;      ///< greatest head error allowed; 0: not asked for
  double flow_change_m3_s = 0;  ///< greatest flow change allowed; 0: not asked for
  int extra_trials = -1;        ///< trials without status changes after max_trials; -1: stop there
  double demand_multiplier = 1;
  double emitter_exponent = 0.5;
  bool emitter_backflow = true;
  bool pressure_driven = false;    ///< demands fall with pressure (PDA)
  double min_pressure_m = 0;       ///< where pressure-driven demand begins
  double required_pressure_m = 0;  ///< where it is whole
  double pressure_exponent = 0.5;
  double head_tolerance_m = 0;     ///< HTOL
  double flow_tolerance_m3_s = 0;  ///< QTOL
  double least_slope_s_m2 = 0;     ///< RQTOL: below this dh/dq a law is made linear
  int check_frequency = 2;         ///< CHECKFREQ
  int max_check = 10;              ///< MAXCHECK
  double damp_limit = 0;           ///< DAMPLIMIT
};

/// Times in whole seconds.
struct HydraulicTimes {
  std::int64_t duration_s = 0;
  std::int64_t hydraulic_step_s = 3600;
  std::int64_t pattern_step_s = 3600;
  std::int64_t pattern_start_s = 0;
  std::int64_t report_step_s = 3600;
  std::int64_t report_start_s = 0;
  std::int64_t rule_step_s = 360;
  std::int64_t start_clock_s = 0;
};

/// A water network as EPANET describes it, in SI. Nodes are numbered junctions, reservoirs, tanks; links are
/// numbered pipes, pumps, valves.
struct HydraulicModel {
  std::string name;
  std::vector<std::string> title;
  std::vector<JunctionNode> junctions;
  std::vector<ReservoirNode> reservoirs;
  std::vector<TankNode> tanks;
  std::vector<PipeLink> pipes;
  std::vector<PumpLink> pumps;
  std::vector<ValveLink> valves;
  std::vector<Pattern> patterns;
  std::vector<SimpleControl> controls;
  std::vector<Rule> rules;
  HydraulicOptions options;
  HydraulicTimes times;
  std::vector<std::string> notes;  ///< what the file asked for and the hydraulics do without

  int junction_count() const { return static_cast<int>(junctions.size()); }
  int reservoir_count() const { return static_cast<int>(reservoirs.size()); }
  int node_count() const { return first_tank() + static_cast<int>(tanks.size()); }
  int first_tank() const { return junction_count() + reservoir_count(); }
  int first_pump() const { return static_cast<int>(pipes.size()); }
  int first_valve() const { return first_pump() + static_cast<int>(pumps.size()); }
  int link_count() const { return first_valve() + static_cast<int>(valves.size()); }

  const std::string& NodeId(int node) const;
  const std::string& LinkId(int link) const;
  /// Elevation of a junction or of a tank's bottom; a reservoir's head.
  double Elevation_m(int node) const;
  int From(int link) const;
  int To(int link) const;
};

}  // namespace piperun::sim
