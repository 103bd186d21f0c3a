// What the model's defaults sound like beside records of the 152 mm PVC rig (docs/acoustics.md).

#include <cmath>

#include "estimator/cross_spectrum.h"
#include "scenarios/sound/groups.h"
#include "scenarios/sound/reference_main.h"

namespace piperun::scenarios::sound {
namespace {

constexpr std::size_t kSegment = 4096;
constexpr double kNoisy_dB = 20;  ///< of distant noise over the quiet default, as beside running pumps

struct Spectrum {
  double width_Hz = 0;
  std::vector<double> psd;

  double Band(double low_Hz, double high_Hz) const {
    double sum = 0;
    for (auto k = static_cast<std::size_t>(std::ceil(low_Hz / width_Hz));
         k <= static_cast<std::size_t>(high_Hz / width_Hz); ++k)
      sum += psd[k];
    return sum;
  }
};

Spectrum Measure(const acoustics::AcousticScene& scene, double s_m, double seconds, std::uint64_t seed) {
  const acoustics::HydrophoneParams params;
  const auto record = Record(scene, params, seed, StandAt(s_m), seconds);
  return {params.rate_Hz / kSegment,
          estimator::CalcCrossSpectra(record, record, params.rate_Hz, kSegment).aa};
}

/// Of the level over log10 f.
double FitSlope_dB_decade(const Spectrum& spectrum, double low_Hz, double high_Hz) {
  double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (double f_Hz = low_Hz; f_Hz < high_Hz; f_Hz *= 1.1, ++n) {
    const double x = std::log10(f_Hz * std::sqrt(1.1));
    const double y = 10 * std::log10(spectrum.Band(f_Hz, 1.1 * f_Hz) / (0.1 * f_Hz));
    sx += x, sy += y, sxx += x * x, sxy += x * y;
  }
  return (sxy - sx * sy / n) / (sxx - sx * sx / n);
}

}  // namespace

void CheckRealism(const ReproduceOptions& options, ReproduceReport& report) {
  FigureChecks checks(report, "realism");
  const double seconds = 300 * options.size;
  acoustics::AcousticScene scene = MakeQuietMain(MakePvcMain());
  scene.ambient = {};
  checks.Near("slope of the default background, drifting ball, 100 to 1000 Hz [dB/decade]",
              FitSlope_dB_decade(Measure(scene, 200, seconds, options.seed), 100, 1000), -25.6, 3,
              "no-leak record, fixed hydrophone, 152 mm PVC rig");
  scene.ambient.distant_level_dB_re_1uPa2_Hz += kNoisy_dB;
  const Spectrum without = Measure(scene, 200, seconds, options.seed);
  AddLeak(scene, {0, 200.5}, MakeJet(1.5e-3 / 60, 1.5e-3, 3e5));
  const Spectrum with = Measure(scene, 200, seconds, options.seed + 1);
  for (const auto& [low_Hz, high_Hz] : {std::pair{800.0, 1600.0}, std::pair{2500.0, 3500.0}}) {
    checks.Between("1.5 L/min at 3 bar, 0.5 m away, over a noisy background, " + std::to_string(int(low_Hz)) +
                       " to " + std::to_string(int(high_Hz)) + " Hz [dB]",
                   10 * std::log10(with.Band(low_Hz, high_Hz) / without.Band(low_Hz, high_Hz)), 4, 10,
                   "crack leaks in the rig; their flow, their distance and the rig's noise are assumed");
  }
}

}  // namespace piperun::scenarios::sound
