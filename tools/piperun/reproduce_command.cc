#include <fmt/core.h>

#include <algorithm>
#include <memory>

#include "base/check.h"
#include "base/nearest_name.h"
#include "scenarios/reproduction.h"
#include "tools/piperun/command.h"
#include "tools/piperun/progress_bar.h"
#include "tools/piperun/table.h"

namespace piperun::tools {
namespace {

struct ReproduceArguments {
  std::string name;
  double size = 1;
  int jobs = 0;
  std::uint64_t seed = 1;
  std::string out;
};

const scenarios::Reproduction& FindReproduction(const std::string& name) {
  std::vector<std::string> known;
  for (const scenarios::Reproduction& reproduction : scenarios::Reproductions()) {
    if (reproduction.name == name) return reproduction;
    known.emplace_back(reproduction.name);
  }
  std::string problem = "there is no such study";
  if (const auto near = FindNearestName(name, known)) problem += "; did you mean '" + *near + "'?";
  throw InputError(problem + " (`piperun reproduce` lists all)", "", name);
}

void PrintList() {
  Table table({"study", "what it shows"});
  for (const scenarios::Reproduction& reproduction : scenarios::Reproductions()) {
    table.Add({std::string(reproduction.name), std::string(reproduction.doc)});
  }
  fmt::print("{}", table.Text());
}

void PrintReport(const scenarios::ReproduceReport& report) {
  for (const scenarios::ReproducedTable& content : report.tables) {
    Table table(content.head);
    for (const auto& row : content.rows) table.Add(row);
    fmt::print("{}\n{}\n", content.title, table.Text());
  }
  const bool sources = std::any_of(report.figures.begin(), report.figures.end(),
                                   [](const scenarios::ReproducedFigure& f) { return !f.source.empty(); });
  std::vector<std::string> head{"figure", "measured", "expected", "result"};
  if (sources) head.emplace_back("by");
  Table figures(head);
  for (const scenarios::ReproducedFigure& f : report.figures) {
    std::vector<std::string> row{f.what, f.measured, f.expected, f.passed ? "ok" : "FAILED"};
    if (sources) row.push_back(f.source);
    figures.Add(row);
  }
  fmt::print("{}", figures.Text());
}

int Reproduce(const ReproduceArguments& arguments, const Display& display) {
  if (arguments.name.empty()) {
    PrintList();
    return kOk;
  }
  const scenarios::Reproduction& reproduction = FindReproduction(arguments.name);
  if (!arguments.out.empty() && !reproduction.draws)
    throw InputError("the study '" + arguments.name + "' draws nothing", "--out");
  scenarios::ReproduceOptions options{arguments.size, arguments.jobs,  arguments.seed,
                                      arguments.out,  &stop_requested, {}};
  scenarios::ReproduceReport report;
  {
    ProgressBar bar(arguments.name, !display.quiet && !display.json);
    options.progress = [&bar](double fraction, const std::string& note) { bar.Update(fraction, note); };
    report = reproduction.run(options);
  }
  if (display.json) {
    fmt::print("{}", scenarios::WriteReproduceJson(reproduction, report));
  } else if (!display.quiet) {
    PrintReport(report);
  }
  return report.passed() ? kOk : kFailed;
}

}  // namespace

void AddReproduceCommand(CLI::App& app, Display& display, int& exit_code) {
  auto arguments = std::make_shared<ReproduceArguments>();
  CLI::App* command =
      app.add_subcommand("reproduce", "Run a study again and hold its figures to what is expected of them");
  command->add_option("NAME", arguments->name, "The study (none: list all)");
  command->add_option("--size", arguments->size, "Share of the runs to make; bounds widen as much")
      ->check(CLI::Range(1e-4, 100.0));
  command->add_option("--jobs", arguments->jobs, "Threads (0: all cores)")->check(CLI::Range(0, 1024));
  command->add_option("--seed", arguments->seed, "Seed of everything drawn");
  command->add_option("-o,--out", arguments->out, "Folder for the plots of a study that draws some");
  command->callback([arguments, &display, &exit_code] { exit_code = Reproduce(*arguments, display); });
}

}  // namespace piperun::tools
