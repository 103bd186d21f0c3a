// A still hydrophone: level, distance, spectrum and distribution of what is rendered.

#include <cmath>

#include "acoustics/level.h"
#include "estimator/cross_spectrum.h"
#include "scenarios/sound/groups.h"
#include "scenarios/sound/reference_main.h"

namespace piperun::scenarios::sound {
namespace {

using acoustics::AcousticScene;
using acoustics::CalcLevel_dB;

constexpr double kHole_m = 200;

/// At a distance from a sound between 980 and 1020 Hz, so that the distance alone tells the level.
double MeasureLevel_dB(double distance_m, const acoustics::PipeWave& wave, double seconds,
                       std::uint64_t seed) {
  AcousticScene scene = MakeQuietMain(wave);
  AddLeak(scene, {0, kHole_m}, MakeBandSound(1e-14, 980, 1020));
  return CalcLevel_dB(
      CalcMeanSquare(Record(scene, MakeIdealHydrophone(), seed, StandAt(kHole_m + distance_m), seconds)));
}

void CheckAttenuation(const ReproduceOptions& options, FigureChecks& checks) {
  const double seconds = 60 * options.size;
  const acoustics::PipeWave pvc = MakePvcMain(), iron = MakeIronMain();
  const auto slope_dB_m = [&](const acoustics::PipeWave& wave, double near_m, double far_m) {
    return (MeasureLevel_dB(near_m, wave, seconds, options.seed) -
            MeasureLevel_dB(far_m, wave, seconds, options.seed)) /
           (far_m - near_m);
  };
  // one seed: the same noise at both places, so that their difference has no scatter
  checks.Relative("attenuation in PVC DN150 at 1 kHz, 0.5 to 10 m [dB/m]", slope_dB_m(pvc, 0.5, 10), 3.21,
                  0.01, "parameter table: 3.21 dB/m");
  checks.Near("attenuation in iron DN150 at 1 kHz, 0.5 to 100 m [dB/m]", slope_dB_m(iron, 0.5, 100), 0.118,
              0.01, "parameter table: 0.118 dB/m");
}

void CheckLevel(const ReproduceOptions& options, FigureChecks& checks) {
  AcousticScene scene = MakeQuietMain(MakePvcMain());
  AddLeak(scene, {0, kHole_m}, MakeBandSound(1e-14, 1000, 5000));
  const double seconds = 600 * options.size;
  const auto record = Record(scene, MakeIdealHydrophone(), options.seed, StandAt(kHole_m + 1), seconds);
  double expected_Pa2 = 0;
  for (double f_Hz = 1000.5; f_Hz < 5000; ++f_Hz)
    expected_Pa2 += acoustics::CalcLeakPsd(scene, scene.leaks[0], {0, kHole_m + 1}, f_Hz);
  const double sigma_dB = 4.343 / std::sqrt(4000 * seconds);
  checks.Near("level of 1 to 5 kHz 1 m from a leak [dB]",
              CalcLevel_dB(CalcMeanSquare(record)) - CalcLevel_dB(expected_Pa2), 0,
              std::fmax(0.05, 4 * sigma_dB), "integral of the formula");
  double fourth = 0;
  for (const float x : record) fourth += std::pow(static_cast<double>(x), 4);
  const double power = CalcMeanSquare(record);
  checks.Near("its kurtosis", fourth / static_cast<double>(record.size()) / (power * power), 3,
              std::fmax(0.05, 4 * std::sqrt(24 / (8000 * seconds))), "Gaussian");
}

/// Power per third octave over the model's, in dB: the worst from 500 Hz on.
void CheckThirdOctaves(const ReproduceOptions& options, FigureChecks& checks) {
  AcousticScene scene = MakeQuietMain(MakePvcMain());
  scene.ambient = {};
  AddLeak(scene, {0, kHole_m}, MakeJet(1e-4 / 60, 1.2e-3, 3e5));
  const acoustics::HydrophoneParams params;
  const double seconds = 600 * options.size, place_m = kHole_m + 1;
  constexpr std::size_t kSegment = 4096;
  const auto record = Record(scene, params, options.seed, StandAt(place_m), seconds);
  const auto spectrum = estimator::CalcCrossSpectra(record, record, params.rate_Hz, kSegment).aa;
  const auto listener = StandAt(place_m)(TrueTime{});
  const double width_Hz = params.rate_Hz / kSegment;
  double worst_dB = 0;
  for (int band = 27; band <= 38; ++band) {  // 500 Hz to 6.3 kHz
    const double centre_Hz = std::pow(10, band / 10.0), edge = std::pow(2, 1.0 / 6);
    double measured = 0, expected = 0;
    for (auto k = static_cast<std::size_t>(centre_Hz / edge / width_Hz);
         k < static_cast<std::size_t>(centre_Hz * edge / width_Hz); ++k) {
      const double f_Hz = static_cast<double>(k) * width_Hz;
      measured += spectrum[k];
      expected +=
          CalcHighPassGain(params, f_Hz) * (CalcLeakPsd(scene, scene.leaks[0], {0, place_m}, f_Hz) +
                                            CalcBackgroundPsd(scene, listener, params.face_radius_m, f_Hz)) +
          CalcSelfNoisePsd(params, f_Hz) + CalcConverterNoisePsd(params);
    }
    worst_dB = std::fmax(worst_dB, std::abs(10 * std::log10(measured / expected)));
  }
  const double sigma_dB = 4.343 / std::sqrt(115 * seconds);  // of the narrowest band
  checks.AtMost("third octaves of leak and background, 500 Hz to 6.3 kHz: worst [dB]", worst_dB,
                std::fmax(0.2, 4 * sigma_dB + 0.05), "the formulas");
}

}  // namespace

void CheckLevels(const ReproduceOptions& options, ReproduceReport& report) {
  FigureChecks checks(report, "still hydrophone");
  CheckAttenuation(options, checks);
  CheckLevel(options, checks);
  CheckThirdOctaves(options, checks);
}

}  // namespace piperun::scenarios::sound
