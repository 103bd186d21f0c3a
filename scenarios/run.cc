#include "scenarios/run.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "scenarios/assemble.h"
#include "scenarios/estimator_bank.h"
#include "scenarios/load.h"
#include "scenarios/measurement_writer.h"
#include "scenarios/output_file.h"
#include "scenarios/run_folder.h"
#include "scenarios/seal.h"
#include "scenarios/stem_recorder.h"
#include "scenarios/truth_log.h"
#include "scenarios/truth_recorder.h"

namespace piperun::scenarios {
namespace {

const char* Name(sim::MotionStatus status) {
  switch (status) {
    case sim::MotionStatus::kRunning:
      return "time_limit";
    case sim::MotionStatus::kArrived:
      return "ok";
    case sim::MotionStatus::kBallStuck:
      return "ball_stuck";
    case sim::MotionStatus::kStalledAtTee:
      return "stalled_at_tee";
    case sim::MotionStatus::kDeadEnd:
      return "dead_end";
    case sim::MotionStatus::kTooLarge:
      return "too_large";
    case sim::MotionStatus::kLeftNetwork:
      return "left_network";
    case sim::MotionStatus::kNotFinite:
      return "not_finite";
  }
  AbortWith("every status has a name", __FILE__, __LINE__);
}

/// How many steps of truth the channels look back and ahead.
std::size_t WindowCapacity(const Assembly& assembly) {
  Duration longest{0};
  Duration ahead{0};
  for (const auto& channel : assembly.channels) {
    longest = std::max(longest, channel->history());
    ahead = std::max(ahead, channel->lookahead() + channel->contact_delay());
  }
  return static_cast<std::size_t>(std::ceil(Seconds(longest + ahead) * assembly.motion->rate().Hz())) + 8;
}

std::vector<std::unique_ptr<MeasurementWriter>> OpenWriters(const Scenario& scenario,
                                                            const Assembly& assembly,
                                                            const RunFolder& folder) {
  const RecordOptions options{assembly.clock.ToRobot(TrueTime{}), scenario.output.audio_format,
                              scenario.mission.time_limit_s};
  std::vector<std::unique_ptr<MeasurementWriter>> writers;
  for (std::size_t i = 0; i < assembly.channels.size(); ++i) {
    const std::string& name = assembly.channel_names[i];
    const auto entry = std::find_if(scenario.sensors.begin(), scenario.sensors.end(),
                                    [&](const SensorEntry& e) { return e.name == name; });
    const auto* sensor = dynamic_cast<const SensorChannel*>(assembly.channels[i].get());
    writers.push_back(MakeMeasurementWriter(*entry, sensor ? sensor->sensor().X_BS() : Pose{}, options,
                                            folder.Folder("mav0/" + name)));
  }
  return writers;
}

/// By channel; null: no stems are kept.
std::vector<std::unique_ptr<StemRecorder>> OpenStems(const Scenario& scenario, const Assembly& assembly,
                                                     const RunFolder& folder) {
  std::vector<std::unique_ptr<StemRecorder>> stems(assembly.channels.size());
  for (std::size_t i = 0; i < stems.size(); ++i) {
    const auto* channel = dynamic_cast<const HydrophoneChannel*>(assembly.channels[i].get());
    if (!channel || channel->hydrophone().StemNames().empty()) continue;
    stems[i] = std::make_unique<StemRecorder>(channel->hydrophone(), scenario.mission.time_limit_s,
                                              folder.Folder("truth/stems/" + assembly.channel_names[i]));
  }
  return stems;
}

/// Truth to measurements to files and filters: the loop.
class RunLoop {
 public:
  RunLoop(const Scenario& scenario, const RunOptions& options, Assembly& assembly, const RunFolder& folder)
      : scenario_(scenario),
        options_(options),
        assembly_(assembly),
        window_(assembly.motion->rate(), WindowCapacity(assembly)),
        truth_(assembly, Rate(scenario.output.truth_rate_Hz.value_or(assembly.motion->rate().Hz())),
               folder.Folder("truth"), folder.Folder("mav0/state_groundtruth_estimate0")),
        writers_(OpenWriters(scenario, assembly, folder)),
        stems_(OpenStems(scenario, assembly, folder)),
        input_(MakeEstimatorInput(scenario, assembly)),
        bank_(input_, folder.staging() / "estimates", [this](RobotTime t) { return TruthAt(t); }),
        truth_file_(folder.staging() / "truth" / "ball.csv") {
    for (const auto& channel : assembly.channels) {
      lookahead_ = std::max(lookahead_, channel->lookahead());
      contact_delay_ = std::max(contact_delay_, channel->contact_delay());
      due_.push_back(channel->due());
      last_due_.push_back(TrueTime::max());
    }
    WriteTextFile(folder.staging() / "estimator_input.yaml",
                  WriteYaml([this](ParamVisitor& v) { input_.Visit(v); }));
  }

  void Run() {
    sim::Motion& motion = *assembly_.motion;
    const TrueTime limit(FromSeconds(scenario_.mission.time_limit_s));
    Push(motion.state());
    while (motion.status() == sim::MotionStatus::kRunning && motion.state().time < limit) {
      motion.Step();
      Tell(motion.contact_events());
      Push(motion.state());
    }
    Drain();
    DeliverReadOuts();
    truth_.WriteUntil(window_.latest_time(), window_);
  }

  RunResult Finish() {
    RunResult result;
    result.status = Name(assembly_.motion->status());
    result.duration_s = Seconds(assembly_.motion->state().time);
    const std::optional<StemSnr> stems = CloseStems();
    result.leaks = truth_.Close(stems ? &*stems : nullptr);
    result.contacts = truth_.contacts();
    for (std::size_t i = 0; i < writers_.size(); ++i) {
      const auto* hydrophone = dynamic_cast<const HydrophoneChannel*>(assembly_.channels[i].get());
      if (hydrophone) writers_[i]->CountDropped(hydrophone->hydrophone().dropped_samples());
      writers_[i]->Close();
    }
    result.estimators = bank_.Finish(result.leaks, scenario_.score.match_radius_m,
                                     [this] { return OpenTruth(truth_file_, assembly_.clock); });
    return result;
  }

 private:
  /// What the first of them tell.
  std::optional<StemSnr> CloseStems() {
    std::optional<StemSnr> snr;
    for (std::size_t i = 0; i < stems_.size(); ++i) {
      if (!stems_[i]) continue;
      stems_[i]->Close();
      if (!snr)
        snr.emplace(assembly_, dynamic_cast<const HydrophoneChannel&>(*assembly_.channels[i]),
                    stems_[i]->folder());
    }
    return snr;
  }

  void Tell(std::span<const sim::ContactEvent> events) {
    for (const sim::ContactEvent& event : events) {
      truth_.Record(event);
      for (const auto& channel : assembly_.channels) channel->Hear(event);
    }
  }

  void Push(const sim::TruthState& state) {
    window_.Push(state);
    truth_.Watch(window_);
    Deliver();
    if (window_.last() % 1024 == 0) Report(state);
  }

  void Deliver() {
    const TrueTime horizon = window_.latest_time() - lookahead_ - contact_delay_;
    DeliverUntil(horizon);
    truth_.WriteUntil(horizon, window_);
  }

  /// What each channel can still measure, whatever the others look ahead; no collision can be told any more.
  void Drain() {
    const TrueTime latest = window_.latest_time();
    for (std::size_t i = 0; i < due_.size(); ++i) {
      last_due_[i] = latest - assembly_.channels[i]->lookahead();
      due_[i] = NextDue(i);
    }
    const Duration step = FromSeconds(window_.rate().Period_s());
    for (TrueTime t = latest - lookahead_ - contact_delay_; t < latest; t += step) {  // as the loop went on
      DeliverUntil(t);
      truth_.WriteUntil(t, window_);
    }
    DeliverUntil(latest);
  }

  /// When channel i measures next; never, when the truth ends before that.
  TrueTime NextDue(std::size_t i) const {
    const TrueTime due = assembly_.channels[i]->due();
    return due <= last_due_[i] ? due : TrueTime::max();
  }

  /// All measurements complete by `horizon`, by time and then channel name.
  void DeliverUntil(TrueTime horizon) {
    while (true) {
      const auto first = std::min_element(due_.begin(), due_.end());
      if (first == due_.end() || *first > horizon) return;
      const auto i = static_cast<std::size_t>(first - due_.begin());
      const Measurement* measurement = assembly_.channels[i]->Take(window_);
      *first = NextDue(i);
      if (!measurement) continue;
      writers_[i]->Write(*measurement);
      if (stems_[i]) stems_[i]->Write(dynamic_cast<HydrophoneChannel&>(*assembly_.channels[i]).hydrophone());
      bank_.Ingest(*measurement);
    }
  }

  /// By stamp and then channel name, as a replay merges them.
  void DeliverReadOuts() {
    std::vector<Measurement> all;
    for (const auto& channel : assembly_.channels) {
      for (Measurement& measurement : channel->ReadOut(window_)) all.push_back(std::move(measurement));
    }
    std::stable_sort(all.begin(), all.end(),
                     [](const Measurement& a, const Measurement& b) { return Stamp(a) < Stamp(b); });
    for (const Measurement& measurement : all) {
      writers_[static_cast<std::size_t>(measurement.channel)]->Write(measurement);
      bank_.Ingest(measurement);
    }
  }

  std::optional<TrackTruth> TruthAt(RobotTime t) const {
    const TrueTime instant = assembly_.clock.ToTrue(t);
    if (instant > window_.latest_time() || instant < SampleTime(window_.first(), window_.rate()))
      return std::nullopt;
    const sim::TruthState state = sim::Interpolate(window_, instant);
    return TrackTruth{state.X_WB.q, state.X_WB.p, state.chainage_m};
  }

  void Report(const sim::TruthState& state) const {
    if (options_.stop && *options_.stop) throw Interrupted();
    const double length_m = assembly_.plan ? assembly_.plan->length_m() : 0;
    if (options_.progress) {
      options_.progress(Seconds(state.time),
                        length_m > 0 ? std::clamp(state.chainage_m / length_m, 0.0, 1.0) : 0);
    }
  }

  const Scenario& scenario_;
  const RunOptions& options_;
  Assembly& assembly_;
  sim::TruthWindow window_;
  TruthRecorder truth_;
  std::vector<std::unique_ptr<MeasurementWriter>> writers_;
  std::vector<std::unique_ptr<StemRecorder>> stems_;
  EstimatorInput input_;
  EstimatorBank bank_;
  std::filesystem::path truth_file_;
  Duration lookahead_{0};
  Duration contact_delay_{0};
  std::vector<TrueTime> due_;       ///< of each channel's next measurement
  std::vector<TrueTime> last_due_;  // per channel: the truth does not reach further
};

void DescribeRoute(const Assembly& assembly, RunResult& result) {
  if (!assembly.pipeline) return;
  const Network& network = assembly.pipeline->network;
  const auto add = [&](int pipe, std::vector<std::string>& names) {
    names.push_back(network.pipe(pipe).id);
    return network.pipe(pipe).length_m;
  };
  for (const RouteLeg& leg : assembly.pipeline->plan) add(leg.pipe, result.planned_pipes);
  result.notes = assembly.pipeline->notes;
  if (const sim::Way* way = assembly.motion->way()) {
    for (const sim::WayLeg& leg : way->legs()) {
      // a ball that arrives at a node amid the network has just entered the pipe beyond
      const bool beyond = assembly.motion->status() == sim::MotionStatus::kArrived &&
                          &leg != &way->legs().front() &&
                          network.NodeAt({leg.pipe, leg.reversed}) == assembly.pipeline->retrieve_node;
      if (!beyond) result.route_length_m += add(leg.pipe, result.route_pipes);
    }
  } else {
    result.route_pipes = result.planned_pipes;
    result.route_length_m = assembly.plan->length_m();
  }
}

/// The scenario as it was run, and the files it refers to, so that the folder can be run again anywhere.
void WriteInputs(const Scenario& scenario, const RunFolder& folder) {
  Scenario copy = scenario;
  const auto keep = [&](const char* name, const std::string& text, std::string& path) {
    if (path.empty()) return;
    path = name;
    WriteTextFile(folder.staging() / name, text);
  };
  keep("network.inp", scenario.network.inp_text, copy.network.inp);
  keep("material_rules.yaml", scenario.network.material_rules_text, copy.network.material_rules);
  WriteTextFile(folder.staging() / "scenario.yaml", WriteScenario(copy));
}

RunResult RunAssembled(const Scenario& scenario, const RunOptions& options, const RunFolder& folder) {
  const std::unique_ptr<Assembly> assembly = Assemble(scenario);
  RunLoop loop(scenario, options, *assembly, folder);
  loop.Run();
  RunResult result = loop.Finish();
  DescribeRoute(*assembly, result);
  if (assembly->pipeline) result.warnings = assembly->pipeline->warnings;
  for (std::string& warning : assembly->motion->warnings()) result.warnings.push_back(std::move(warning));
  return result;
}

}  // namespace

RunResult Run(const Scenario& scenario, const RunOptions& options) {
  const auto begin = StartWatch();
  RunFolder folder(options.out, options.force);
  RunResult result;
  try {
    result = RunAssembled(scenario, options, folder);
  } catch (const HydraulicsDiverged& e) {
    result.status = "hydraulics_diverged";
    result.notes.push_back(e.what());
  }
  WriteInputs(scenario, folder);
  result.scenario = scenario.name;
  result.seed = scenario.seed;
  result.run = scenario.run;
  Seal(folder, begin, result);
  return result;
}

}  // namespace piperun::scenarios
