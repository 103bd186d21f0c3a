#pragma once

#include <string_view>
#include <vector>

namespace piperun::scenarios {

/// A text file of the source tree that is part of the binary, so that an installed piperun needs no folder.
struct EmbeddedFile {
  std::string_view name;  ///< without folder and extension
  std::string_view text;
};

const std::vector<EmbeddedFile>& EmbeddedScenarios();      ///< scenarios/library/*.yaml
const std::vector<EmbeddedFile>& EmbeddedMaterials();      ///< assets/materials/*.yaml
const std::vector<EmbeddedFile>& EmbeddedSoils();          ///< assets/soils/*.yaml
const std::vector<EmbeddedFile>& EmbeddedLinings();        ///< assets/linings/*.yaml
const std::vector<EmbeddedFile>& EmbeddedBalls();          ///< assets/balls/*.yaml
const std::vector<EmbeddedFile>& EmbeddedSensors();        ///< assets/sensors/*.yaml
const std::vector<EmbeddedFile>& EmbeddedNetworks();       ///< assets/networks/*.inp
const std::vector<EmbeddedFile>& EmbeddedMaterialRules();  ///< assets/materials/rules/*.yaml

}  // namespace piperun::scenarios
