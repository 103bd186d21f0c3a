#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <memory>

#include "base/check.h"
#include "base/nearest_name.h"
#include "base/number.h"
#include "base/params.h"
#include "base/water.h"
#include "scenarios/embedded.h"
#include "scenarios/load.h"
#include "scenarios/network_report.h"
#include "scenarios/network_svg.h"
#include "scenarios/output_file.h"
#include "scenarios/pipeline.h"
#include "sim/network/inp_reader.h"
#include "tools/piperun/ball_way_text.h"
#include "tools/piperun/command.h"
#include "tools/piperun/network_text.h"
#include "tools/piperun/progress_bar.h"
#include "tools/piperun/sound_text.h"

namespace piperun::tools {
namespace {

struct NetworkArguments {
  std::string file;
  bool extended = false;
  bool csv = false;
  bool all = false;
  bool sound = false;
  std::string accuracy, ball_mm, from, to, svg;
};

double ReadOption(const std::string& text, const char* option, const Range& range) {
  const auto value = ParseNumber(text);
  if (!value) throw InputError("'" + text + "' is not a number", option);
  if (!range.Contains(*value)) throw InputError("is " + text + "; allowed: " + range.Text(), option);
  return *value;
}

int FindNode(const sim::HydraulicModel& model, const std::string& id, const char* option) {
  std::vector<std::string> ids;
  for (int i = 0; i < model.node_count(); ++i) {
    if (model.NodeId(i) == id) return i;
    ids.push_back(model.NodeId(i));
  }
  const auto nearest = FindNearestName(id, ids);
  throw InputError("there is no node '" + id + "'" + (nearest ? "; did you mean '" + *nearest + "'?" : ""),
                   option);
}

scenarios::BallQuestion ReadQuestion(const sim::HydraulicModel& model, const NetworkArguments& arguments) {
  scenarios::BallQuestion question;
  question.ask_passage = !arguments.ball_mm.empty();
  if (question.ask_passage) {
    question.ball_diameter_m = 1e-3 * ReadOption(arguments.ball_mm, "--ball-mm", {.min = 1, .max = 5000});
  }
  if (!arguments.from.empty()) question.from = FindNode(model, arguments.from, "--from");
  if (!arguments.to.empty()) question.to = FindNode(model, arguments.to, "--to");
  return question;
}

sim::HydraulicModel LoadNetwork(const std::string& path) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) {
    throw InputError("this is a folder; give an EPANET input file", "", path);
  }
  const auto size = std::filesystem::file_size(path, ignored);
  if (!ignored && size > sim::kMaxInpBytes) sim::RefuseSize(size, path);
  return sim::ReadInp(scenarios::ReadTextFile(path), path);
}

/// What a scenario's EPANET file becomes with the scenario's leaks in it.
sim::HydraulicModel LoadScenarioNetwork(const std::string& name) {
  const scenarios::Scenario scenario = scenarios::LoadScenario(name);
  if (scenario.network.inp.empty()) {
    throw InputError(
        "this scenario writes its pipes down, and they carry one flow in series; only networks from "
        "EPANET files are solved",
        "network", name);
  }
  return *scenarios::BuildPipeline(scenario, CalcWater(scenario.water.temperature_C)).hydraulics;
}

/// An EPANET file, one of our own networks by name, or a scenario.
sim::HydraulicModel Load(const std::string& name) {
  const std::filesystem::path path(name);
  if (path.extension() == ".yaml" || path.extension() == ".yml") return LoadScenarioNetwork(name);
  if (std::filesystem::exists(path)) return LoadNetwork(name);
  const auto is_named = [&](const scenarios::EmbeddedFile& file) { return file.name == name; };
  const auto& networks = scenarios::EmbeddedNetworks();
  const auto own = std::find_if(networks.begin(), networks.end(), is_named);
  if (own != networks.end()) return sim::ReadInp(own->text, name);
  const auto& catalogue = scenarios::EmbeddedScenarios();
  if (std::any_of(catalogue.begin(), catalogue.end(), is_named)) return LoadScenarioNetwork(name);
  return LoadNetwork(name);
}

scenarios::NetworkSolution Solve(const sim::HydraulicModel& model, const NetworkArguments& arguments,
                                 const Display& display) {
  ProgressBar bar(model.name, !display.quiet);
  scenarios::NetworkOptions options;
  options.extended = arguments.extended;
  options.stop = &stop_requested;
  const auto duration = static_cast<double>(std::max<std::int64_t>(model.times.duration_s, 1));
  options.progress = [&](std::int64_t time_s) {
    bar.Update(static_cast<double>(time_s) / duration, fmt::format("{} h", time_s / 3600));
  };
  return scenarios::SolveNetwork(model, options);
}

void Print(const sim::HydraulicModel& model, const scenarios::NetworkSolution& solution,
           const scenarios::BallQuestion& question, const NetworkArguments& arguments,
           const Display& display) {
  if (display.json || arguments.csv) {
    if (!display.quiet) {
      for (const std::string& note : model.notes) fmt::print(stderr, "piperun: note: {}\n", note);
    }
    fmt::print("{}",
               display.json ? WriteNetworkJson(model, solution, question) : WriteNetworkCsv(model, solution));
  } else if (!display.quiet) {
    fmt::print("{}{}", DescribeNetwork(model, solution, arguments.all),
               DescribeBallWays(model, solution.steps.front().state, question, arguments.all));
  }
}

/// False when --to asks for a node the water does not come by.
bool IsReachable(const sim::HydraulicModel& model, const scenarios::NetworkSolution& solution,
                 const scenarios::BallQuestion& question) {
  if (!question.to) return true;
  const sim::WaterWays ways(model, solution.steps.front().state, question.ball_diameter_m);
  return ways.FindFastest(*question.from, *question.to).has_value();
}

int ReportNetwork(sim::HydraulicModel model, const NetworkArguments& arguments, const Display& display) {
  if (!arguments.accuracy.empty()) {
    model.options.accuracy =
        ReadOption(arguments.accuracy, "--accuracy", {.min = 0, .max = 0.1, .min_open = true});
  }
  if (arguments.csv && display.json) throw InputError("choose one of --csv and --json", "--csv");
  const scenarios::BallQuestion question = ReadQuestion(model, arguments);
  const scenarios::NetworkSolution solution = Solve(model, arguments, display);
  Print(model, solution, question, arguments, display);
  if (!arguments.svg.empty()) {
    scenarios::WriteTextFile(arguments.svg,
                             scenarios::DrawModelSvg(model, solution.steps.front().state, question.from,
                                                     question.to, question.ball_diameter_m));
  }
  if (!solution.converged()) {
    fmt::print(stderr, "piperun: {}: {}\n", model.name, solution.problem);
    return kFailed;
  }
  if (!IsReachable(model, solution, question)) {
    fmt::print(stderr, "piperun: {}: no way from '{}' to '{}'\n", model.name, arguments.from, arguments.to);
    return kFailed;
  }
  return kOk;
}

/// The pipes of a scenario as sound finds them.
int ReportSound(const NetworkArguments& arguments, const Display& display) {
  if (std::filesystem::path(arguments.file).extension() == ".inp") {
    throw InputError("needs walls, which a scenario gives; `piperun scenario new` makes one from this file",
                     "--sound", arguments.file);
  }
  if (display.json) throw InputError("choose --csv, or neither", "--json");
  const scenarios::Scenario scenario = scenarios::LoadScenario(arguments.file);
  if (arguments.csv || !display.quiet) {
    fmt::print("{}", arguments.csv ? WriteSoundCsv(scenario) : DescribeSound(scenario, arguments.all));
  }
  return kOk;
}

constexpr const char* kFooter =
    "CSV columns: time_s, element (node or link), id, kind, then for nodes elevation_m, head_m, pressure_m,\n"
    "demand_m3_s, for links from, to, flow_m3_s, velocity_m_s, head_loss_m, status.\n"
    "demand_m3_s is what leaves the pipes: customers, emitters and leaks of a junction; what flows into a\n"
    "reservoir or tank, negative while it feeds the network. Flow counts from -> to.\n"
    "Ways and passage are those of the first instant told of.";

}  // namespace

void AddNetworkCommand(CLI::App& app, Display& display, int& exit_code) {
  auto arguments = std::make_shared<NetworkArguments>();
  CLI::App* command = app.add_subcommand("network", "Solve an EPANET network: heads, flows, ways of a ball");
  command
      ->add_option(
          "FILE", arguments->file,
          "EPANET 2.2 or 2.3 input file (.inp), one of piperun's own networks by name, or a scenario on one")
      ->required();
  command->add_flag("--extended", arguments->extended,
                    "The whole period, every reporting step (default: t = 0)");
  command->add_option("--accuracy", arguments->accuracy, "Instead of the file's ACCURACY, in (0, 0.1]");
  command->add_option("--ball-mm", arguments->ball_mm, "Tell which links a ball of this diameter passes");
  CLI::Option* from =
      command->add_option("--from", arguments->from, "Tell where the water takes the ball from this node");
  command->add_option("--to", arguments->to, "Tell the fastest way to this node")->needs(from);
  command->add_option("--svg", arguments->svg,
                      "Draw the network in plan, with --from and --to the way between");
  command->add_flag("--sound", arguments->sound,
                    "Tell how the pipes of a scenario carry sound: speed, dB/m, ring frequency, cut-on");
  command->add_flag("--all", arguments->all, "Print tables in full");
  command->add_flag("--csv", arguments->csv, "Print results as CSV");
  command->footer(kFooter);
  command->callback([arguments, &display, &exit_code] {
    exit_code = arguments->sound ? ReportSound(*arguments, display)
                                 : ReportNetwork(Load(arguments->file), *arguments, display);
  });
}

}  // namespace piperun::tools
