#include <fmt/core.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "base/check.h"
#include "base/number.h"
#include "scenarios/physical_unit.h"
#include "tools/piperun/command.h"

namespace piperun::tools {
namespace {

struct ConvertArguments {
  std::string value, unit, range;
  int bits = 0;
};

/// "2000deg/s" or "2000 deg/s"
scenarios::FullScale ReadFullScale(const ConvertArguments& arguments) {
  scenarios::FullScale scale;
  if (arguments.bits > 0) scale.bits = arguments.bits;
  if (arguments.range.empty()) return scale;
  const std::size_t end = arguments.range.find_first_not_of("+-.0123456789eE");
  const auto number = ParseNumber(arguments.range.substr(0, end));
  if (!number || *number <= 0)
    throw InputError("'" + arguments.range + "' is not a range like 2000deg/s", "--range");
  const auto unit =
      scenarios::ParseUnit(end == std::string::npos ? "1" : arguments.range.substr(end), "--range");
  scale.range_si = *number * unit.factor;
  scale.range_unit = scenarios::SiUnitText(unit);
  return scale;
}

void Convert(const ConvertArguments& arguments, const Display& display) {
  const auto value = ParseNumber(arguments.value);
  if (!value) throw InputError("'" + arguments.value + "' is not a number", "VALUE");
  const auto si = scenarios::ConvertToSi(*value, arguments.unit, ReadFullScale(arguments));
  const std::string unit = scenarios::SiUnitText(si.unit);
  nlohmann::ordered_json others = nlohmann::ordered_json::object();
  for (const std::string_view other : scenarios::DataSheetUnits(si.unit)) {
    others[std::string(other)] = si.value / scenarios::ParseUnit(other, "").factor;
  }
  if (display.json) {
    const nlohmann::ordered_json json{{"value", si.value}, {"unit", unit}, {"data_sheet", others}};
    fmt::print("{}\n", json.dump());
    return;
  }
  const bool celsius = arguments.unit.find('C') != std::string::npos;
  fmt::print("{} {} = {:.10g} {}{}\n", arguments.value, arguments.unit, si.value, unit,
             celsius ? " (a difference of temperature)" : "");
  for (const auto& [name, other] : others.items()) fmt::print("  = {:.6g} {}\n", other.get<double>(), name);
}

}  // namespace

void AddConvertUnitsCommand(CLI::App& app, Display& display, int& exit_code) {
  auto arguments = std::make_shared<ConvertArguments>();
  CLI::App* command =
      app.add_subcommand("convert-units", "A data-sheet value in SI and in the other usual units");
  command->add_option("VALUE", arguments->value, "A number")->required();
  command
      ->add_option("UNIT", arguments->unit,
                   "deg/h, deg/sqrt(h), mdps/sqrt(Hz), ug/sqrt(Hz), mg, ppm, %FS, LSB ..")
      ->required();
  command->add_option("--range", arguments->range, "What %FS and LSB refer to, e.g. 2000deg/s: +- so much");
  command->add_option("--bits", arguments->bits, "Bits of the register, for LSB")->check(CLI::Range(1, 64));
  command->callback([arguments, &display, &exit_code] {
    Convert(*arguments, display);
    exit_code = kOk;
  });
}

}  // namespace piperun::tools
