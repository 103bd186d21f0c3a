#include "scenarios/estimator_input.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/check.h"
#include "estimator/filter_kind.h"
#include "scenarios/network_params.h"

namespace piperun::scenarios {
namespace {

std::string TypeOfChannel(const Scenario& scenario, const std::string& name) {
  const auto entry = std::find_if(scenario.sensors.begin(), scenario.sensors.end(),
                                  [&](const SensorEntry& e) { return e.name == name; });
  return std::string(entry->kind.records());
}

double HeadingFromMap(const Assembly& assembly) {
  const Vector3d t = assembly.plan->Eval(0).tangent_W;
  return std::atan2(t.y(), t.x());
}

ToldParams Tell(const StartParams& start, const Scenario& scenario, const Assembly& assembly,
                const std::string& key_path) {
  ToldParams told;
  told.map = start.map == "as_built" && assembly.plan;
  if (start.heading == "from_map") {
    if (!told.map) {
      throw InputError("there is no map to take the heading from; say 'heading: given' or 'heading: unknown'",
                       key_path + ".heading", scenario.sources.Find(key_path));
    }
    told.heading_rad = HeadingFromMap(assembly);
  } else if (start.heading == "given") {
    told.heading_rad = start.heading_rad;
  }
  told.chainage_m = assembly.motion->state().chainage_m;  // 0, or a little way into the pipe at a junction
  told.chainage_sd_m = start.chainage_sd_m;
  told.p_W = assembly.motion->planned_start_W();
  told.heading_sd_rad = start.heading_sd_rad;
  told.ball_radius_m = start.ball_radius_m.value_or(scenario.ball.radius_m);
  told.ball_radius_sd_m = start.ball_radius_sd_m;
  told.gravity_m_s2 = scenario.gravity_m_s2;
  told.field_W_T = start.field_W_T;
  if (assembly.imu) {
    const Pose X_BS = assembly.imu->sensor().X_BS();
    told.p_BS_m = X_BS.p;
    std::copy_n(std::array{X_BS.q.w(), X_BS.q.x(), X_BS.q.y(), X_BS.q.z()}.begin(), 4, told.q_BS);
  }
  return told;
}

std::vector<RouteLeg> MakeLegs(const Network& network, const std::vector<MapLeg>& way) {
  std::vector<RouteLeg> legs;
  for (std::size_t i = 0; i < way.size(); ++i) {
    const std::string key = "map.way[" + std::to_string(i) + "].pipe";
    legs.push_back({network.RequirePipe(way[i].pipe, key), way[i].reversed});
  }
  if (legs.empty()) throw InputError("the way through the map is missing", "map.way");
  return legs;
}

/// The planned way, and of the network as much as a crew would print for it.
MapParams MakeMap(const Pipeline& pipeline) {
  const Network& network = pipeline.network;
  std::vector<bool> node_used(network.nodes().size()), pipe_used(network.pipes().size());
  const auto use_pipe = [&](int pipe) {
    pipe_used[static_cast<std::size_t>(pipe)] = true;
    node_used[static_cast<std::size_t>(network.pipe(pipe).from)] = true;
    node_used[static_cast<std::size_t>(network.pipe(pipe).to)] = true;
  };
  MapParams map;
  for (const RouteLeg& leg : pipeline.plan) {
    map.way.push_back({network.pipe(leg.pipe).id, leg.reversed});
    for (const int node : {network.pipe(leg.pipe).from, network.pipe(leg.pipe).to}) {
      for (const PipeEnd& end : network.EndsAt(node)) use_pipe(end.pipe);
    }
  }
  for (std::size_t i = 0; i < node_used.size(); ++i) {
    if (node_used[i]) map.network.nodes.push_back(pipeline.drawing.nodes[i]);
  }
  for (std::size_t i = 0; i < pipe_used.size(); ++i) {
    if (!pipe_used[i]) continue;
    map.network.pipes.push_back(pipeline.drawing.pipes[i]);
    map.network.pipes.back().sound = {};  // what lies around a pipe is not on the crew's drawing
  }
  for (const FittingEntry& fitting : pipeline.drawing.fittings) {
    const auto pipe = network.FindPipe(fitting.pipe);
    if (pipe && pipe_used[static_cast<std::size_t>(*pipe)]) map.network.fittings.push_back(fitting);
  }
  return map;
}

estimator::EstimatorStart MakeStart(const EstimatorInput& input, const ToldParams& told) {
  estimator::EstimatorStart start;
  if (told.map) {
    Network network = MakeNetwork(input.map.network);
    Route way(network, MakeLegs(network, input.map.way));
    auto fittings = MakeFittings(input.map.network, network);
    start.map.emplace(estimator::RouteMap{std::move(network), std::move(way), std::move(fittings)});
  }
  start.chainage_m = told.chainage_m;
  start.chainage_sd_m = told.chainage_sd_m;
  start.p_W = told.p_W;
  start.heading_rad = told.heading_rad;
  start.heading_sd_rad = told.heading_sd_rad;
  start.ball_radius_m = told.ball_radius_m;
  start.ball_radius_sd_m = told.ball_radius_sd_m;
  start.gravity_m_s2 = told.gravity_m_s2;
  start.field_W_T = told.field_W_T;
  start.X_BS = {told.p_BS_m, Quaterniond(told.q_BS[0], told.q_BS[1], told.q_BS[2], told.q_BS[3])};
  return start;
}

void RequireChannel(const EstimatorInput& input, std::string_view type, const std::string& what,
                    const std::string& key_path) {
  const bool there = std::any_of(input.channels.begin(), input.channels.end(),
                                 [&](const RecordedChannel& channel) { return channel.type == type; });
  if (!there) throw InputError("this filter needs " + what + ", and nothing records one", key_path);
}

}  // namespace

void MapLeg::Visit(ParamVisitor& v) {
  v.Text({"pipe", "Its name.", true}, pipe);
  v.Flag({"reversed", "Travelled from its `to` node to its `from` node."}, reversed);
}

void MapParams::Visit(ParamVisitor& v) {
  v.Struct({"network", "Nodes and pipes as drawn."}, network);
  v.Items({"way", "The planned way, pipe by pipe; chainage 0 at its beginning."}, way);
  v.Struct({"origin", "Where on earth its coordinates begin."}, origin);
}

void ToldParams::Visit(ParamVisitor& v) {
  v.Flag({"map", "Whether this filter gets the map."}, map);
  v.Number({"chainage_m", "Chainage at launch."}, Range::Any(), chainage_m);
  v.Number({"chainage_sd_m", "Its standard deviation."}, Range::NonNegative(), chainage_sd_m);
  v.Vector({"p_W_m", "Launch position of the ball's centre."}, Range::Any(), p_W);
  v.NumberOr({"heading_rad", "Direction of travel at launch, from east towards north."}, Range::Any(),
             "unknown", heading_rad);
  v.Number({"heading_sd_rad", "Its standard deviation."}, Range::NonNegative(), heading_sd_rad);
  v.Number({"ball_radius_m", "Nominal radius."}, Range::Positive(), ball_radius_m);
  v.Number({"ball_radius_sd_m", "Its standard deviation."}, Range::NonNegative(), ball_radius_sd_m);
  v.Number({"gravity_m_s2", "Gravity."}, Range::NonNegative(), gravity_m_s2);
  v.Vector({"field_W_T", "Magnetic reference field: east, north, up."}, Range::Any(), field_W_T);
  v.Vector({"p_BS_m", "IMU in the ball, as drawn."}, Range::Any(), p_BS_m);
  v.Array({"q_BS", "Its orientation, w x y z."}, Range::Between(-1, 1), q_BS);
}

void ToldEstimator::Visit(ParamVisitor& v) {
  kind.Visit(v);
  v.Struct({"start", "What it is told before the launch."}, start);
}

void RecordedChannel::Visit(ParamVisitor& v) {
  static constexpr std::array<std::string_view, 6> kTypes{"imu",         "magnetometer", "pressure",
                                                          "temperature", "marker",       "audio"};
  v.Text({"name", "Folder under mav0/.", true}, name);
  v.Choice({"type", "What it records.", true}, kTypes, type);
}

void EstimatorInput::Visit(ParamVisitor& v) {
  static constexpr std::array<std::string_view, 1> kSchemas{"piperun.estimator_input/1"};
  v.Choice({"schema", "Version of this file format.", true}, kSchemas, schema);
  v.Number({"track_rate_Hz", "How often the track is written."}, {.min = 0.1, .max = 1e4}, track_rate_Hz);
  v.Items({"channels", "What was recorded."}, channels);
  v.Struct({"map", "Drawings of the pipeline."}, map);
  v.NamedItems({"estimators", "Filters, by name."}, estimators);
}

EstimatorInput MakeEstimatorInput(const Scenario& scenario, const Assembly& assembly) {
  EstimatorInput input;
  input.track_rate_Hz = scenario.output.track_rate_Hz;
  for (const std::string& name : assembly.channel_names) {
    input.channels.push_back({name, TypeOfChannel(scenario, name)});
  }
  if (assembly.pipeline) input.map = MakeMap(*assembly.pipeline);
  input.map.origin = scenario.network.origin;
  for (const EstimatorEntry& entry : scenario.estimators) {
    input.estimators.push_back(
        {entry.name, entry.kind,
         Tell(entry.start, scenario, assembly, "estimators." + entry.name + ".start")});
  }
  return input;
}

EstimatorInput LoadEstimatorInput(const std::string& path) {
  EstimatorInput input;
  YamlDocument::FromFile(path).Read([&](ParamVisitor& v) { input.Visit(v); });
  return input;
}

std::unique_ptr<estimator::Estimator> MakeEstimator(const EstimatorInput& input, const ToldEstimator& told) {
  const auto& kinds = estimator::FilterKinds();
  const std::string key_path = "estimators." + told.name;
  const auto kind =
      std::find_if(kinds.begin(), kinds.end(), [&](const auto& k) { return k.name == told.kind.kind(); });
  Demand(kind != kinds.end(), "a filter's kind was checked when it was read");
  const estimator::ChannelNeeds needs = kind->needs(told.kind.params());
  if (needs.imu) RequireChannel(input, "imu", "an IMU", key_path);
  if (needs.audio) RequireChannel(input, "audio", "a hydrophone (or 'locator: {kind: none}')", key_path);
  try {
    return kind->make(told.kind.params(), MakeStart(input, told.start));
  } catch (const InputError& e) {
    throw InputError(e.problem(), key_path + (e.key_path().empty() ? "" : "." + e.key_path()));
  }
}

}  // namespace piperun::scenarios
