#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <memory>

#include "base/check.h"
#include "scenarios/assemble.h"
#include "scenarios/embedded.h"
#include "scenarios/estimator_input.h"
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

/// A scenario of the catalogue as a file of the user's own, comments included.
void New(const std::string& path, const std::string& from) {
  if (std::filesystem::exists(path)) {
    throw InputError("this file exists already; choose another name", "", path);
  }
  const auto& catalogue = scenarios::EmbeddedScenarios();
  const auto found =
      std::find_if(catalogue.begin(), catalogue.end(), [&](const auto& f) { return f.name == from; });
  if (found == catalogue.end())
    throw InputError("there is no scenario '" + from + "' in the catalogue", "--from");
  scenarios::WriteTextFile(path, found->text);
  fmt::print("Wrote {}; run it with: piperun run {} --out runs/{}\n", path, path,
             std::filesystem::path(path).stem().string());
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

  auto path = std::make_shared<std::string>();
  auto from = std::make_shared<std::string>("quickstart");
  CLI::App* create = command->add_subcommand("new", "Write a scenario file to start from");
  create->add_option("FILE", *path, "File to write")->required();
  create->add_option("--from", *from, "Scenario of the catalogue to copy")->capture_default_str();
  create->callback([path, from] { New(*path, *from); });
}

}  // namespace piperun::tools
