#include "scenarios/scenario.h"

#include <array>

#include "base/check.h"
#include "scenarios/ball_presets.h"
#include "scenarios/materials.h"
#include "scenarios/sensor_presets.h"

namespace piperun::scenarios {
namespace {

/// Tells every sensor where to look for a preset's file.
class SensorMap : public VectorParamMap<SensorEntry> {
 public:
  explicit SensorMap(Scenario& scenario)
      : VectorParamMap(scenario.sensors), sensors_(scenario.sensors), folder_(scenario.folder) {}
  void Add(const std::string& name) override {
    VectorParamMap::Add(name);
    sensors_.back().folder = folder_;
  }

 private:
  std::vector<SensorEntry>& sensors_;
  const std::filesystem::path& folder_;
};

/// The preset's section for this kind. `preset` becomes "none" where it is a file.
KindEntry StartFromPreset(const std::string& kind, const std::filesystem::path& folder, std::string& preset) {
  const SensorPreset loaded = LoadSensorPreset(preset, folder);
  const KindEntry* section = loaded.Find(kind);
  if (!section) {
    throw InputError("the preset '" + preset + "' has no " + kind + "; it has: " + loaded.Kinds(), "preset");
  }
  if (loaded.from_file) preset = "none";
  return *section;
}

}  // namespace

void WaterParams::Visit(ParamVisitor& v) {
  v.Number({"temperature_C", "Water temperature; sets density, viscosity and speed of sound."},
           Range::Between(0, 60), temperature_C);
}

void NodeEntry::Visit(ParamVisitor& v) {
  v.Text({"id", "Name of the node.", true}, id);
  v.Vector({"position_m", "East, north, up (elevation of the pipe's axis).", true}, Range::Between(-1e6, 1e6),
           position_m);
  v.Flag({"open_water", "A reservoir or tank: a ball that comes here has left the pipes."}, open_water);
}

void WallParams::Visit(ParamVisitor& v) {
  v.Number({"young_modulus_Pa", "Young's modulus."}, Range::Positive(), young_modulus_Pa);
  v.Number({"loss_factor", "Effective loss factor: wall, lining, joints, deposits."}, Range::Between(0, 1),
           loss_factor);
  v.Number({"poisson_ratio", "Poisson's ratio."}, {.min = 0, .max = 0.5}, poisson_ratio);
  v.Number({"density_kg_m3", "Density of the wall."}, Range::Positive(), density_kg_m3);
  v.Number({"roughness_m", "Equivalent sand-grain roughness of the bore."}, Range::NonNegative(),
           roughness_m);
  v.Number({"relative_permeability", "Of the wall in a field as weak as the earth's; 1: not magnetic."},
           {.min = 1, .max = 1e6}, relative_permeability);
}

void PipeEntry::Visit(ParamVisitor& v) {
  v.Text({"id", "Name of the pipe.", true}, id);
  v.Text({"from", "Node where the pipe's own length s begins.", true}, from);
  v.Text({"to", "Node where it ends.", true}, to);
  v.Number({"diameter_m", "Inner diameter (bore).", true}, {.min = 0.01, .max = 10}, diameter_m);
  v.Number({"wall_thickness_m", "Wall thickness.", true}, {.min = 1e-4, .max = 1}, wall_thickness_m);
  const std::vector<std::string_view> names = MaterialNames();
  v.Choice({"material", "Wall material, a name from the material library."}, names, material);
  wall = FindWall(material, wall);
  v.Struct({"wall", "Properties of the wall, where they differ from the material's."}, wall);
  v.Table({"vertices_m", "Corners between the nodes, rows of east, north, up."}, Range::Between(-1e6, 1e6), 3,
          vertices_m);
  v.Number(
      {"bend_radius_m",
       "Radius of the axis in every corner, and where two pipes that both give one meet at an angle; must "
       "exceed the bore's radius. 0: none."},
      Range::NonNegative(), bend_radius_m);
  v.NumberOr(
      {"length_m", "Length as stated; the drawing is stretched to it. As drawn: the line's own length."},
      {.min = 1e-3, .max = 1e6}, "as_drawn", length_m);
  v.Flag({"fit_bends", "Bends that do not fit are made tighter or left out instead of refused."}, fit_bends);
  v.Flag({"passable", "Whether a ball gets through; not through pumps, closed and throttling valves."},
         passable);
  v.Number(
      {"minor_loss",
       "K of everything in the pipe that costs head but is neither friction nor a bend, spread along it: "
       "h = K U^2/(2g). An EPANET file brings its own."},
      {.min = 0, .max = 1e4}, minor_loss);
  sound.Visit(v);
}

void FittingEntry::Visit(ParamVisitor& v) {
  v.Text({"id", "Name of the fitting.", true}, id);
  v.Choice({"kind", "What it is."}, std::array<std::string_view, 3>{"pump", "valve", "service"}, kind);
  v.Text({"pipe", "Pipe it is on.", true}, pipe);
  v.Number({"s_m", "Distance along that pipe from its `from` node."}, Range::NonNegative(), s_m);
}

void NetworkParams::Visit(ParamVisitor& v) {
  v.Items({"nodes", "Ends of pipes."}, nodes);
  v.Items({"pipes", "Pipes: straight lines with rounded corners, from node to node."}, pipes);
  v.Items({"fittings",
           "Pumps, valves and services as the crew's drawings show them, for telling their noise from a "
           "leak's; those of an EPANET file and tees are known without."},
          fittings);
}

void NetworkSource::Visit(ParamVisitor& v) {
  v.Text(
      {"inp",
       "EPANET input file with the pipes and their hydraulics, instead of nodes and pipes here: a path seen "
       "from this file, or the name of one of piperun's own networks."},
      inp);
  v.NumberOr({"map_unit_m", "Length of one unit of the EPANET file's coordinates."}, Range::Positive(),
             "fitted", map_unit_m);
  v.Number(
      {"bend_radius_diameters",
       "EPANET file: radius of the axis in corners over the pipe's diameter, less where it does not fit."},
      Range::Between(0.6, 100), bend_radius_diameters);
  v.Text({"material_rules",
          "EPANET file: rules that give every pipe its material and wall (empty: piperun's own)."},
         material_rules);
  sound.Visit(v);
  v.Struct(
      {"origin", "Where on earth the coordinates begin; then leaks are also written as dig points, GeoJSON."},
      origin);
  NetworkParams::Visit(v);
}

void FlowParams::Visit(ParamVisitor& v) {
  v.Number({"inlet_m3_s", "Flow entering at the launch node; an EPANET file brings its own."},
           {.min = 0, .max = 100}, inlet_m3_s);
  v.Number(
      {"inlet_pressure_Pa", "Gauge pressure on the axis at the launch node; an EPANET file brings its own."},
      {.min = 0, .max = 1e8}, inlet_pressure_Pa);
  v.Flag({"bend_losses",
          "Whether bends cost head beyond their friction (Ito 1960); an EPANET file brings its own minor "
          "losses."},
         bend_losses);
  v.Number({"launch_time_s", "EPANET file: when in its extended period the ball is launched."},
           {.min = 0, .max = 1e9}, launch_time_s);
}

void LeakEntry::Visit(ParamVisitor& v) {
  v.Text({"id", "Name of the leak.", true}, id);
  v.Text({"pipe", "Pipe it is on.", true}, pipe);
  v.Number({"s_m", "Distance along that pipe from its `from` node.", true}, Range::NonNegative(), s_m);
  v.Number({"hole_diameter_m", "Diameter of the (circular) hole.", true},
           {.min = 0, .max = 0.1, .min_open = true}, hole_diameter_m);
  v.Number({"area_slope_m",
            "Area by which the hole grows per metre of pressure head (m2/m; FAVAD). 0: a rigid hole."},
           Range::Between(0, 1e-3), area_slope_m);
  v.Number({"cd", "Discharge coefficient of the hole."}, {.min = 0, .max = 1, .min_open = true}, cd);
  v.Struct({"sound", "How it sounds."}, sound);
}

void SoundEntry::Visit(ParamVisitor& v) {
  v.Text({"id", "Name of the sound; no leak has the same.", true}, id);
  v.Text({"pipe", "Pipe it is in; empty: it is at a node."}, pipe);
  v.Number({"s_m", "Distance along that pipe from its `from` node."}, Range::NonNegative(), s_m);
  v.Text({"node", "Node it is at, instead of a place in a pipe."}, node);
  v.NumberOr({"on_s", "When it begins, after the launch."}, Range::Between(-1e6, 1e6), "always", on_s);
  v.NumberOr({"off_s", "When it ends."}, Range::Between(-1e6, 1e6), "never", off_s);
  v.Number({"ramp_s", "How long it takes to begin, after on_s, and to end, before off_s."},
           Range::Between(0.001, 3600), ramp_s);
  kind.Visit(v);
}

void WallFeatureEntry::Visit(ParamVisitor& v) {
  v.Text({"id", "Name of the feature; those of a series get a number, ID[1].", true}, id);
  v.Text({"pipe", "Pipe it is in; \"*\": every pipe open to the ball.", true}, pipe);
  kind.Visit(v);
}

void RandomLeaksParams::Visit(ParamVisitor& v) {
  static constexpr std::array<std::string_view, 2> kPlaces{"way", "network"};
  v.Integer({"count", "How many."}, 0, 1000, count);
  v.Choice({"where", "On the planned way, or on any pipe; uniform over the length."}, kPlaces, where);
  v.Number({"min_hole_diameter_m", "Smallest hole; the diameter is drawn log-uniformly."},
           {.min = 0, .max = 0.1, .min_open = true}, min_hole_diameter_m);
  v.Number({"max_hole_diameter_m", "Largest hole."}, {.min = 0, .max = 0.1, .min_open = true},
           max_hole_diameter_m);
  v.Number({"min_spacing_m", "Least distance from other leaks on the pipe and from its ends."},
           Range::Between(0.01, 1e4), min_spacing_m);
  v.Number({"cd", "Discharge coefficient of the holes."}, {.min = 0, .max = 1, .min_open = true}, cd);
}

void BallEntry::Visit(ParamVisitor& v) {
  const std::string before = preset;
  v.Choice(
      {"preset", "Ball of the library that the other keys' defaults are those of; none: as listed here."},
      BallPresetNames(), preset);
  if (preset != before) sim::BallParams::operator=(FindBall(preset));
  sim::BallParams::Visit(v);
}

void ViaEntry::Visit(ParamVisitor& v) { v.Text({"node", "Node on the way.", true}, node); }

void MissionParams::Visit(ParamVisitor& v) {
  v.Text({"launch",
          "Node where the ball is put in, at rest on the invert; chainage 0. A ball lighter than water "
          "rises to the crown at once."},
         launch);
  static constexpr std::array<std::string_view, 2> kBranches{"free", "pinned"};
  v.Text({"retrieve", "Node where it is taken out; empty: wherever the water takes it."}, retrieve);
  v.Items({"via", "Nodes that the planned way passes, in order."}, via);
  v.Choice({"branches",
            "Where pipes meet: free lets ball and water decide; pinned grates over all pipes that are not on "
            "the planned way."},
           kBranches, branches);
  v.Number({"lateral_sd_m", "Scatter of the launch place around the wall, one sigma."}, Range::Between(0, 1),
           lateral_sd_m);
  v.Number({"time_limit_s", "The run ends here at the latest."}, {.min = 0.1, .max = 1e6}, time_limit_s);
  v.Number({"stuck_after_s", "A ball that advances less than 1 cm in this time is stuck."},
           {.min = 1, .max = 1e5}, stuck_after_s);
}

void SensorEntry::Visit(ParamVisitor& v) {
  kind.VisitKind(v);
  const std::string before = preset;
  v.Text({"preset",
          "Board whose values the other keys' defaults are: a name of the library, or a file of that form "
          "(`piperun allan --preset`), seen from this one; none: as listed with the kind."},
         preset);
  if (preset != before && preset != "none") kind = StartFromPreset(kind.kind(), folder, preset);
  kind.VisitParams(v);
}

void StartParams::Visit(ParamVisitor& v) {
  static constexpr std::array<std::string_view, 2> kMaps{"as_built", "none"};
  static constexpr std::array<std::string_view, 3> kHeadings{"from_map", "given", "unknown"};
  v.Choice({"map", "Drawings of the pipeline the filter gets."}, kMaps, map);
  v.Choice({"heading", "Where the direction of travel at launch comes from."}, kHeadings, heading);
  v.Number(
      {"heading_rad", "Direction of travel at launch, from east towards north; used with heading: given."},
      Range::Between(-7, 7), heading_rad);
  v.Number({"heading_sd_rad", "Its standard deviation."}, {.min = 0, .max = 4, .min_open = true},
           heading_sd_rad);
  v.Number({"chainage_sd_m", "Standard deviation of the launch chainage."}, Range::Between(0, 1e3),
           chainage_sd_m);
  v.NumberOr({"ball_radius_m", "Radius the filter believes in."}, {.min = 1e-3, .max = 5}, "as_built",
             ball_radius_m);
  v.Number({"ball_radius_sd_m", "Its standard deviation."}, Range::Between(0, 1), ball_radius_sd_m);
  v.Vector({"field_W_T", "Magnetic reference field: east, north, up."}, Range::Between(-1e-3, 1e-3),
           field_W_T);
}

void EstimatorEntry::Visit(ParamVisitor& v) {
  kind.Visit(v);
  v.Struct({"start", "What the filter is told before the launch."}, start);
}

void ScoreParams::Visit(ParamVisitor& v) {
  v.Number({"match_radius_m", "An estimate farther than this from a leak does not count as finding it."},
           {.min = 0, .max = 1e4, .min_open = true}, match_radius_m);
}

void OutputParams::Visit(ParamVisitor& v) {
  static constexpr std::array<std::string_view, 3> kFormats{"wav", "wav_float", "flac"};
  v.NumberOr({"truth_rate_Hz", "Rows per second of truth/ball.csv."}, {.min = 0.1, .max = 1e5}, "physics",
             truth_rate_Hz);
  v.Number({"track_rate_Hz", "Rows per second of every estimated track, where it is scored."},
           {.min = 0.1, .max = 1e4}, track_rate_Hz);
  v.Choice(
      {"audio_format", "Container of the hydrophone record; all hold the converter's counts bit for bit."},
      kFormats, audio_format);
}

void ExpectEntry::Visit(ParamVisitor& v) {
  v.Text({"path", "JSON pointer into run.json.", true}, path);
  v.NumberOr({"min", "Smallest value allowed."}, Range::Any(), "none", min);
  v.NumberOr({"max", "Largest value allowed."}, Range::Any(), "none", max);
  v.Text({"equals", "Text the value must equal (empty: not compared)."}, equals);
}

void Scenario::Visit(ParamVisitor& v) {
  static constexpr std::array<std::string_view, 1> kSchemas{"piperun.scenario/1"};
  v.Choice({"schema", "Version of this file format.", true}, kSchemas, schema);
  v.Text({"name", "Name of the scenario.", true}, name);
  v.Text({"description", "One or two sentences about it."}, description);
  v.Integer({"seed", "Seed of all noise."}, 0, INT64_MAX, seed);
  v.Integer({"run", "Run index: another draw of everything random under the same seed."}, 0, INT64_MAX, run);
  v.Number({"gravity_m_s2", "Gravity, along -z."}, {.min = 0, .max = 100, .min_open = true}, gravity_m_s2);
  v.Struct({"water", "The water."}, water);
  v.Struct({"network", "The pipes."}, network);
  v.Struct({"flow", "What enters at the launch node."}, flow);
  v.Struct({"ambient", "What the hydrophone hears besides leaks."}, ambient);
  v.Items({"leaks", "Holes in the wall."}, leaks);
  v.Struct({"random_leaks", "Holes drawn by seed and run."}, random_leaks);
  v.Items({"sounds", "What sounds and is no leak: pumps, draw-offs, valves, gas pockets."}, sounds);
  v.Items({"wall_features", "What the ball runs into: joints, beads, scale, valves, holes."}, wall_features);
  v.Struct({"motion", "What moves the ball."}, motion);
  v.Struct({"ball", "The ball."}, ball);
  v.Struct({"mission", "Where it goes in and out, and when to give up."}, mission);
  SensorMap sensor_map(*this);
  v.Map({"sensors", "Recording channels, by name."}, sensor_map);
  v.NamedItems({"estimators", "Filters in the loop, by name."}, estimators);
  v.Struct({"score", "How estimates are compared with the truth."}, score);
  v.Struct({"output", "What is written."}, output);
  v.Items({"expect", "What `piperun check` holds run.json to."}, expect);
}

}  // namespace piperun::scenarios
