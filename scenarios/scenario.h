#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "acoustics/ambient.h"
#include "base/params.h"
#include "scenarios/geo_origin.h"
#include "scenarios/kind_entry.h"
#include "scenarios/pipe_sound.h"
#include "scenarios/yaml_document.h"
#include "sim/ball.h"

namespace piperun::scenarios {

struct WaterParams {
  double temperature_C = 10;
  void Visit(ParamVisitor& v);
};

struct NodeEntry {
  std::string id;
  Vector3d position_m = Vector3d::Zero();
  bool open_water = false;
  void Visit(ParamVisitor& v);
};

/// What a wall is made of. Read, it starts from the named material of the library; what the file says on top
/// of that counts.
struct WallParams {
  double young_modulus_Pa = 0;
  double loss_factor = 0;
  double poisson_ratio = 0;
  double density_kg_m3 = 0;
  double roughness_m = 0;
  double relative_permeability = 1;
  void Visit(ParamVisitor& v);
};

struct PipeEntry {
  std::string id;
  std::string from;
  std::string to;
  double diameter_m = 0;
  double wall_thickness_m = 0;
  std::string material = "pvc_u";
  WallParams wall;
  std::vector<double> vertices_m;  ///< rows of three
  double bend_radius_m = 0;
  std::optional<double> length_m;  ///< nothing: as drawn
  bool fit_bends = false;
  bool passable = true;
  double minor_loss = 0;
  PipeSoundParams sound;
  void Visit(ParamVisitor& v);
};

/// What the crew's drawings show besides pipes: where a noise need not be a leak.
struct FittingEntry {
  std::string id;
  std::string kind = "valve";
  std::string pipe;
  double s_m = 0;
  void Visit(ParamVisitor& v);
};

struct NetworkParams {
  std::vector<NodeEntry> nodes;
  std::vector<PipeEntry> pipes;
  std::vector<FittingEntry> fittings{};
  void Visit(ParamVisitor& v);
};

/// Pipes written down here, or those of an EPANET file.
struct NetworkSource : NetworkParams {
  std::string inp;
  std::optional<double> map_unit_m;  ///< nothing: fitted to the stated lengths
  double bend_radius_diameters = 1.5;
  std::string material_rules;
  NetworkSoundParams sound;  ///< of all pipes
  GeoOrigin origin;
  std::string inp_text;             ///< of the file `inp`, read with the scenario
  std::string material_rules_text;  ///< of the file `material_rules`; empty: piperun's own rules
  void Visit(ParamVisitor& v);
};

struct FlowParams {
  double inlet_m3_s = 0;
  double inlet_pressure_Pa = 0;
  bool bend_losses = true;
  double launch_time_s = 0;
  void Visit(ParamVisitor& v);
};

struct LeakEntry {
  std::string id;
  std::string pipe;
  double s_m = 0;
  double hole_diameter_m = 0;
  double area_slope_m = 0;
  double cd = 0.6;
  KindEntry sound{LeakSoundOptions, "turbulent_jet"};
  void Visit(ParamVisitor& v);
};

/// Something that sounds and is no leak.
struct SoundEntry {
  std::string id;
  std::string pipe;
  double s_m = 0;
  std::string node;             ///< instead of pipe and s_m
  std::optional<double> on_s;   ///< nothing: from the beginning
  std::optional<double> off_s;  ///< nothing: to the end
  double ramp_s = 0.1;
  KindEntry kind{SoundOptions, "draw_off"};
  void Visit(ParamVisitor& v);
};

/// Something on the wall that the ball runs into; or many of them.
struct WallFeatureEntry {
  std::string id;
  std::string pipe;
  KindEntry kind{WallFeatureOptions, "joint"};
  void Visit(ParamVisitor& v);
};

/// Leaks drawn by seed and run index, on top of those that are listed.
struct RandomLeaksParams {
  std::int64_t count = 0;
  std::string where = "way";
  double min_hole_diameter_m = 0.001;
  double max_hole_diameter_m = 0.005;
  double min_spacing_m = 5;
  double cd = 0.6;
  void Visit(ParamVisitor& v);
};

struct ViaEntry {
  std::string node;
  void Visit(ParamVisitor& v);
};

/// The ball. Read, it starts from the named preset of the library; what the file says on top of that counts.
struct BallEntry : sim::BallParams {
  std::string preset = "none";
  void Visit(ParamVisitor& v);
};

struct MissionParams {
  std::string launch;
  std::string retrieve;
  std::vector<ViaEntry> via;
  std::string branches = "free";
  double lateral_sd_m = 0;
  double time_limit_s = 3600;
  double stuck_after_s = 30;
  void Visit(ParamVisitor& v);
};

/// A recording channel. Read, it starts from the preset's section for its kind; what the file says on top of
/// that counts. Once read, a preset that was a file is "none": its values are here.
struct SensorEntry {
  std::string name;
  std::string preset = "none";
  KindEntry kind{SensorOptions, "imu"};
  std::filesystem::path folder;  ///< where a preset's file is looked for
  void Visit(ParamVisitor& v);
};

/// What the crew tells a filter before the launch. Assumed values, never the truth's own.
struct StartParams {
  std::string map = "as_built";
  std::string heading = "from_map";
  double heading_rad = 0;
  double heading_sd_rad = 0.02;
  double chainage_sd_m = 0.01;
  std::optional<double> ball_radius_m;  ///< nothing: as built
  double ball_radius_sd_m = 0;
  Vector3d field_W_T{2.6e-6, 25.1e-6, -40.4e-6};
  void Visit(ParamVisitor& v);
};

struct EstimatorEntry {
  std::string name;
  KindEntry kind{FilterOptions, "quaternion_ekf"};
  StartParams start;
  void Visit(ParamVisitor& v);
};

struct ScoreParams {
  double match_radius_m = 2;
  void Visit(ParamVisitor& v);
};

struct OutputParams {
  std::optional<double> truth_rate_Hz;  ///< nothing: every physics step
  double track_rate_Hz = 20;
  std::string audio_format = "wav";
  void Visit(ParamVisitor& v);
};

/// A promise about run.json that `piperun check` holds a run to.
struct ExpectEntry {
  std::string path;  ///< JSON pointer
  std::optional<double> min;
  std::optional<double> max;
  std::string equals;
  void Visit(ParamVisitor& v);
};

/// One run of one ball, as a user writes it down. All values in SI.
struct Scenario {
  std::string schema = "piperun.scenario/1";
  std::string name;
  std::string description;
  std::int64_t seed = 1;
  std::int64_t run = 0;
  double gravity_m_s2 = 9.80665;
  WaterParams water;
  NetworkSource network;
  FlowParams flow;
  acoustics::AmbientParams ambient;
  std::vector<LeakEntry> leaks;
  RandomLeaksParams random_leaks;
  std::vector<SoundEntry> sounds;
  std::vector<WallFeatureEntry> wall_features;
  KindEntry motion{MotionOptions, "ball_in_pipe"};
  BallEntry ball;
  MissionParams mission;
  std::vector<SensorEntry> sensors;
  std::vector<EstimatorEntry> estimators;
  ScoreParams score;
  OutputParams output;
  std::vector<ExpectEntry> expect;
  std::filesystem::path folder;  ///< of the file it was read from: files it names are looked for there
  SourceMap sources;             ///< where each value stands in the file it was read from

  void Visit(ParamVisitor& v);
};

}  // namespace piperun::scenarios
