#include "tools/piperun/sound_text.h"

#include <fmt/core.h>

#include <array>
#include <vector>

#include "base/water.h"
#include "scenarios/acoustic_scene.h"
#include "tools/piperun/long_table.h"
#include "tools/piperun/number_text.h"

namespace piperun::tools {
namespace {

constexpr double kDecibelPerNeper = 8.685889638065035;
constexpr std::array<double, 3> kFrequencies_Hz{100, 1000, 3000};

const std::vector<std::string> kHead{"pipe",      "material",    "bore_mm",    "wall_mm",
                                     "soil",      "c_m_s_100Hz", "dB_m_100Hz", "dB_m_1kHz",
                                     "dB_m_3kHz", "ring_Hz",     "cut_on_Hz"};

std::vector<std::vector<std::string>> ListRows(const scenarios::Scenario& scenario) {
  const WaterProperties water = CalcWater(scenario.water.temperature_C);
  const scenarios::Pipeline pipeline = scenarios::BuildPipeline(scenario, water);
  const auto network = scenarios::MakeAcousticNetwork(pipeline, water, scenario.gravity_m_s2);
  std::vector<std::vector<std::string>> rows;
  for (std::size_t i = 0; i < network.pipes.size(); ++i) {
    const Pipe& pipe = pipeline.network.pipes()[i];
    const acoustics::PipeWave& wave = network.pipes[i].wave;
    std::vector<std::string> row{pipe.id,
                                 pipe.material.name,
                                 Fixed(1000 * pipe.diameter_m, 1),
                                 Fixed(1000 * pipe.wall_thickness_m, 1),
                                 pipeline.drawing.pipes[i].sound.soil,
                                 Fixed(wave.Speed_m_s(kFrequencies_Hz[0]), 0)};
    for (const double f_Hz : kFrequencies_Hz)
      row.push_back(Fixed(kDecibelPerNeper * wave.Attenuation_Np_m(f_Hz), 3));
    row.push_back(Fixed(wave.ring_frequency_Hz, 0));
    row.push_back(Fixed(wave.cut_on_Hz, 0));
    rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace

std::string DescribeSound(const scenarios::Scenario& scenario, bool whole) {
  LongTable table(kHead, whole);
  for (auto& row : ListRows(scenario)) table.Add(std::move(row));
  return table.Text("pipes") +
         "\nc and dB/m of the plane wave (docs/acoustics.md); its law holds to 0.15 of the ring frequency, "
         "and\n"
         "from the first cut-on the plane wave is not alone.\n";
}

std::string WriteSoundCsv(const scenarios::Scenario& scenario) {
  std::string text;
  const auto add_line = [&](const std::vector<std::string>& cells) {
    for (std::size_t i = 0; i < cells.size(); ++i) text += (i ? "," : "") + cells[i];
    text += "\n";
  };
  add_line(kHead);
  for (const auto& row : ListRows(scenario)) add_line(row);
  return text;
}

}  // namespace piperun::tools
