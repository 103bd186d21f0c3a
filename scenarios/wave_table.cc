#include "scenarios/wave_table.h"

namespace piperun::scenarios {
namespace {

std::vector<double> ListNumbers(const acoustics::PipeSection& section) {
  std::vector<double> numbers{section.bore_diameter_m, static_cast<double>(section.law)};
  for (const acoustics::WallLayer& layer : section.layers) {
    const WallMaterial& m = layer.material;
    for (const double x :
         {layer.thickness_m, m.young_modulus_Pa, m.loss_factor, m.poisson_ratio, m.density_kg_m3})
      numbers.push_back(x);
  }
  if (const auto& soil = section.soil) {
    for (const double x : {soil->bulk_modulus_Pa, soil->shear_modulus_Pa, soil->density_kg_m3})
      numbers.push_back(x);
  }
  return numbers;
}

}  // namespace

const acoustics::PipeWave& WaveTable::Find(const acoustics::PipeSection& section) {
  const std::vector<double> numbers = ListNumbers(section);
  const auto found = waves_.find(numbers);
  if (found != waves_.end()) return found->second;
  return waves_.emplace(numbers, acoustics::CalcPipeWave(section, water_)).first->second;
}

}  // namespace piperun::scenarios
