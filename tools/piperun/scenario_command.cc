#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <memory>

#include "base/check.h"
#include "scenarios/assemble.h"
#include "scenarios/embedded.h"
#include "scenarios/estimator_input.h"
#include "scenarios/inp_scenario.h"
#include "scenarios/load.h"
#include "scenarios/output_file.h"
#include "scenarios/reference.h"
#include "tools/piperun/command.h"
#include "tools/piperun/table.h"

namespace piperun::tools {
namespace {

void List() {
  Table table({"scenario", "what it is"});
  for (const auto& file : scenarios::EmbeddedScenarios()) {
    const auto scenario = scenarios::LoadScenario(std::string(file.name));
    table.Add({scenario.name, scenario.description});
  }
  fmt::print("{}", table.Text());
}

void Validate(const std::vector<std::string>& names, const Display& display) {
  for (const std::string& name : names) {
    const auto scenario = scenarios::LoadScenario(name);
    const auto assembly = scenarios::Assemble(scenario);
    const auto input = scenarios::MakeEstimatorInput(scenario, *assembly);
    for (const auto& told : input.estimators) scenarios::MakeEstimator(input, told);
    if (!display.quiet) fmt::print("{}: valid\n", name);
  }
}

struct NewOptions {
  std::string path;
  std::string inp;
  std::string from;
  std::string to;
};

void WriteNew(const std::string& path, std::string_view text) {
  if (std::filesystem::exists(path)) {
    throw InputError("this file exists already; choose another name", "", path);
  }
  scenarios::WriteTextFile(path, text);
  fmt::print("Wrote {}; run it with: piperun run {} --out runs/{}\n", path, path,
             std::filesystem::path(path).stem().string());
}

/// A scenario of the catalogue as a file of the user's own, comments included.
void CopyFromCatalogue(const NewOptions& options) {
  if (options.path.empty()) throw InputError("name the file to write", "FILE");
  if (!options.to.empty()) throw InputError("a node to arrive at goes with --inp", "--to");
  const std::string from = options.from.empty() ? "quickstart" : options.from;
  const auto& catalogue = scenarios::EmbeddedScenarios();
  const auto found =
      std::find_if(catalogue.begin(), catalogue.end(), [&](const auto& f) { return f.name == from; });
  if (found == catalogue.end())
    throw InputError("there is no scenario '" + from + "' in the catalogue", "--from");
  WriteNew(options.path, found->text);
}

/// The plan, with what is wrong about its nodes told by the options that name them.
scenarios::InpScenarioPlan PlanFromOptions(const NewOptions& options) {
  try {
    return scenarios::PlanInpScenario(options.inp, options.from, options.to);
  } catch (const InputError& e) {
    if (e.key_path() == "mission.launch") throw InputError(e.problem(), "--from", e.where());
    if (e.key_path() == "mission.retrieve") throw InputError(e.problem(), "--to", e.where());
    throw;
  }
}

/// A scenario on an EPANET file; it is written beside the user, called like the file.
void StartFromInp(const NewOptions& options) {
  if (options.from.empty()) throw InputError("name the node where the ball goes in", "--from");
  if (options.to.empty()) throw InputError("name the node where it is taken out", "--to");
  auto plan = PlanFromOptions(options);
  const std::string path = options.path.empty() ? plan.name + ".yaml" : options.path;
  plan.inp_path =
      std::filesystem::proximate(options.inp, std::filesystem::absolute(path).parent_path()).string();
  WriteNew(path, scenarios::MakeInpScenario(plan));
}

}  // namespace

void AddScenarioCommand(CLI::App& app, Display& display, int&) {
  CLI::App* command = app.add_subcommand("scenario", "List, show, validate and start scenarios");
  command->require_subcommand(1);
  command->add_subcommand("list", "The catalogue")->callback(List);
  command->add_subcommand("reference", "Every key of the scenario file, as Markdown")->callback([] {
    fmt::print("{}", scenarios::WriteReference());
  });

  auto shown = std::make_shared<std::string>();
  CLI::App* show = command->add_subcommand("show", "Print a scenario with every value in effect, in SI");
  show->add_option("SCENARIO", *shown, "Scenario file or name")->required();
  show->callback([shown] { fmt::print("{}", scenarios::WriteScenario(scenarios::LoadScenario(*shown))); });

  auto validated = std::make_shared<std::vector<std::string>>();
  CLI::App* validate = command->add_subcommand("validate", "Check scenarios without running them");
  validate->add_option("SCENARIO", *validated, "Scenario files or names")->required();
  validate->callback([validated, &display] { Validate(*validated, display); });

  auto options = std::make_shared<NewOptions>();
  CLI::App* create = command->add_subcommand("new", "Write a scenario file to start from");
  create->add_option("FILE", options->path, "File to write; with --inp by default called like that file");
  create->add_option("--inp", options->inp, "EPANET file to make a scenario on");
  create->add_option("--from", options->from,
                     "With --inp: node where the ball goes in. Else: scenario of the catalogue to copy "
                     "(quickstart)");
  create->add_option("--to", options->to, "With --inp: node where the ball is taken out");
  create->callback([options] {
    if (options->inp.empty()) return CopyFromCatalogue(*options);
    StartFromInp(*options);
  });
}

}  // namespace piperun::tools
