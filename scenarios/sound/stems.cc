// What stems are for: the SNR that is measured in them is that of the model.

#include <cmath>

#include "estimator/cross_spectrum.h"
#include "scenarios/sound/groups.h"
#include "scenarios/sound/reference_main.h"

namespace piperun::scenarios::sound {
namespace {

constexpr double kLow_Hz = 1000, kHigh_Hz = 4000;

double MeasureBand_Pa2(const std::vector<float>& record, double rate_Hz) {
  constexpr std::size_t kSegment = 4096;
  const auto spectrum = estimator::CalcCrossSpectra(record, record, rate_Hz, kSegment).aa;
  const double width_Hz = rate_Hz / kSegment;
  double sum = 0;
  for (auto k = static_cast<std::size_t>(kLow_Hz / width_Hz);
       k < static_cast<std::size_t>(kHigh_Hz / width_Hz); ++k) {
    sum += width_Hz * spectrum[k];
  }
  return sum;
}

}  // namespace

void CheckStems(const ReproduceOptions& options, ReproduceReport& report) {
  FigureChecks checks(report, "stems");
  acoustics::AcousticScene scene = MakeQuietMain(MakePvcMain());
  scene.ambient = {};
  AddLeak(scene, {0, 200}, MakeJet(1e-4 / 60, 1.2e-3, 3e5));
  AddLeak(scene, {0, 203}, MakeJet(3e-5, 2e-3, 3e5));
  acoustics::HydrophoneParams params;
  params.stems = true;
  acoustics::Hydrophone hydrophone(params, scene, RandomStream(options.seed, "hydrophone0", 0));
  const auto listener = StandAt(200.5);
  std::vector<std::vector<float>> stems_Pa(hydrophone.StemNames().size());
  std::vector<std::int32_t> block(static_cast<std::size_t>(params.block_samples));
  const double seconds = 100 * options.size;
  double worst_counts = 0;
  for (int i = 0; i < static_cast<int>(10 * seconds); ++i) {
    hydrophone.Render(listener, block);
    std::vector<double> sum_Pa(block.size());
    for (std::size_t stem = 0; stem < stems_Pa.size(); ++stem) {
      const auto part_Pa = hydrophone.stem_Pa(stem);
      stems_Pa[stem].insert(stems_Pa[stem].end(), part_Pa.begin(), part_Pa.end());
      for (std::size_t n = 0; n < block.size(); ++n) sum_Pa[n] += static_cast<double>(part_Pa[n]);
    }
    for (std::size_t n = 0; n < block.size(); ++n)
      worst_counts = std::fmax(worst_counts, std::abs(sum_Pa[n] / params.scale_Pa() - block[n]));
  }
  checks.AtMost("sum of the stems less the record: worst [counts of 24 bits]", worst_counts, 0.51,
                "half a count is the converter's");
  std::vector<double> model_Pa2(3);
  hydrophone.CalcBandPower(listener(TrueTime{}), kLow_Hz, kHigh_Hz, model_Pa2);
  double noise_Pa2 = 0;
  for (std::size_t stem = 2; stem < stems_Pa.size(); ++stem)
    noise_Pa2 += MeasureBand_Pa2(stems_Pa[stem], params.rate_Hz);
  for (std::size_t leak = 0; leak < 2; ++leak) {
    const double measured_dB = 10 * std::log10(MeasureBand_Pa2(stems_Pa[leak], params.rate_Hz) / noise_Pa2);
    checks.Near("SNR of leak " + std::to_string(leak + 1) + " between 1 and 4 kHz, from stems [dB]",
                measured_dB, 10 * std::log10(model_Pa2[leak] / model_Pa2[2]),
                0.05 + 4 * 4.343 * std::sqrt(2 / (2000 * seconds)), "the model's spectra");
  }
}

}  // namespace piperun::scenarios::sound
