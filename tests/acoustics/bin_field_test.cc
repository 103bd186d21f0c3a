#include "acoustics/bin_field.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "acoustics/phasor.h"
#include "tests/acoustics/scenes.h"

namespace piperun::acoustics {
namespace {

constexpr double kBin_Hz = 15.625;
constexpr std::size_t kBins = 513;

/// 10 dB below each other, so that a row that is mixed up is found out.
std::vector<std::vector<float>> MakeSpectra(std::size_t sources) {
  std::vector<std::vector<float>> spectra;
  for (std::size_t i = 0; i < sources; ++i)
    spectra.emplace_back(kBins, static_cast<float>(std::pow(10, -static_cast<double>(i))));
  return spectra;
}

std::vector<float> SpectrumAt(BinField& field, std::size_t source, const PipePlace& place) {
  std::vector<float> psd(kBins, 0);
  field.Add(source, place, psd);
  return psd;
}

/// Mean of |Z|^2 over a bin by 256 frequencies.
double CalcMeanPower(const AcousticNetwork& network, const PipePlace& source, const PipePlace& place,
                     std::size_t bin) {
  constexpr int kFine = 256;
  std::vector<double> f_Hz;
  for (int i = 0; i < kFine; ++i)
    f_Hz.push_back((static_cast<double>(bin) - 0.5 + (i + 0.5) / kFine) * kBin_Hz);
  const NetworkField field(network, {source}, f_Hz);
  double sum = 0;
  for (std::size_t i = 0; i < f_Hz.size(); ++i) sum += std::norm(field.Impedance_Pa_s_m3(i, 0, place));
  return sum / kFine;
}

TEST(Phasor, IsCosineAndSine) {
  for (int i = -1000; i <= 1000; ++i) {
    const double turns = 0.5e-3 * i;
    const Phasor p = CalcPhasor(static_cast<float>(turns));
    EXPECT_NEAR(p.cos, std::cos(2 * std::numbers::pi * turns), 1e-6) << turns;
    EXPECT_NEAR(p.sin, std::sin(2 * std::numbers::pi * turns), 1e-6) << turns;
  }
}

TEST(BinField, AlongAPipeThatGoesOnItIsTheFormula) {
  for (const PipeWave& wave : {MakePvcWave(), MakeIronWave()}) {
    const AcousticNetwork network{{{0, 1, 100, wave}}, {NodeEnd::kGoesOn, NodeEnd::kGoesOn}, {}, {}};
    BinField field(network, {{0, 40}}, MakeSpectra(1), kBin_Hz, {0});
    for (const double s_m : {-0.05, 10.0, 39.9, 40.0, 40.02, 47.0, 100.03}) {
      const std::vector<float> psd = SpectrumAt(field, 0, {0, s_m});
      for (const std::size_t bin : {1, 20, 100, 500}) {
        const double loss_Np = wave.Attenuation_Np_m(static_cast<double>(bin) * kBin_Hz) * std::abs(s_m - 40);
        const double expected = std::pow(wave.impedance_Pa_s_m3 / 2, 2) * std::exp(-2 * loss_Np);
        if (loss_Np > 9) continue;  // beyond 80 dB it is left out
        EXPECT_NEAR(psd[bin] / expected, 1, 2e-3) << s_m << " m, bin " << bin;
      }
    }
  }
}

TEST(BinField, StandingWavesInFrontOfADeadEndHaveTheirNodesAndBellies) {
  // the echo of a dead end 1.3 m away is within a frame: 1 + cos(2 k d) in front of it, but for loss
  const PipeWave wave = MakeIronWave();
  const AcousticNetwork network{{{0, 1, 60, wave}}, {NodeEnd::kGoesOn}, {}, {}};
  BinField field(network, {{0, 10}}, MakeSpectra(1), kBin_Hz, {0});
  const double largest = std::pow(wave.impedance_Pa_s_m3, 2);
  for (const double s_m : {58.7, 59.0, 59.42, 59.9, 60.0}) {
    const std::vector<float> psd = SpectrumAt(field, 0, {0, s_m});
    for (const std::size_t bin : {12, 57, 140}) {
      const double expected = CalcMeanPower(network, {0, 10}, {0, s_m}, bin);
      EXPECT_NEAR(psd[bin] / largest, expected / largest, 0.01) << s_m << " m, bin " << bin;
    }
  }
}

TEST(BinField, StandingWavesKeepTheirPlacesInADispersivePipe) {
  // 400 mm of steel 6 mm thick: a tenth of its ring frequency is bin 27, 0.15 bin 40; in between the speed
  // falls by 0.5 %, and over 30 m from the middle of the stretch the phase moves by an eighth of a turn
  const PipeWave wave =
      CalcPipeWave(PipeSection{.4, {{.006, MakeWall(207e9, .002, .29, 7850)}}, {}, {}}, MakeWater10C());
  ASSERT_LT(wave.Speed_m_s(5000), 0.996 * wave.speed_m_s);
  const AcousticNetwork network{{{0, 1, 60, wave}}, {NodeEnd::kGoesOn}, {}, {}};
  BinField field(network, {{0, 10}}, MakeSpectra(1), kBin_Hz, {0});
  const double largest = std::pow(wave.impedance_Pa_s_m3, 2);
  for (const double s_m : {55.7, 58.7, 59.42, 59.9, 60.0}) {
    const std::vector<float> psd = SpectrumAt(field, 0, {0, s_m});
    for (std::size_t bin = 20; bin < 60; ++bin) {
      const double expected = CalcMeanPower(network, {0, 10}, {0, s_m}, bin);
      EXPECT_NEAR(psd[bin] / largest, expected / largest, 0.015) << s_m << " m, bin " << bin;
    }
  }
}

TEST(BinField, BandsHaveThePowerOfTheFineSpectrum) {
  // a ring with a spur, a tee at every node: echoes of all delays
  const PipeWave iron = MakeIronWave(), pvc = MakePvcWave();
  const AcousticNetwork network{{{0, 1, 43, iron},
                                 {1, 2, 71, iron},
                                 {2, 3, 57, iron},
                                 {3, 0, 65, iron},
                                 {1, 4, 23, pvc},
                                 {3, 5, 190, iron}},
                                {NodeEnd::kClosed, NodeEnd::kClosed, NodeEnd::kClosed, NodeEnd::kClosed,
                                 NodeEnd::kClosed, NodeEnd::kOpenWater},
                                {},
                                {}};
  const std::vector<PipePlace> sources{{0, 20}, {1, 30}};
  BinField field(network, sources, MakeSpectra(2), kBin_Hz, {0, 1, 2});
  double sum_dB = 0;
  int places = 0;
  for (const PipePlace& place : {PipePlace{0, 11}, PipePlace{1, 30.5}, PipePlace{1, 3}, PipePlace{2, 20}}) {
    for (std::size_t source = 0; source < 2; ++source) {
      const std::vector<float> psd = SpectrumAt(field, source, place);
      double expected = 0, measured = 0;
      for (std::size_t bin = 64; bin < 128; ++bin) {
        expected += CalcMeanPower(network, sources[source], place, bin);
        measured += psd[bin] * std::pow(10, static_cast<double>(source));
      }
      const double error_dB = 10 * std::log10(measured / expected);
      EXPECT_NEAR(error_dB, 0, 0.8) << place.pipe << " " << place.s_m;
      sum_dB += error_dB, ++places;
    }
  }
  EXPECT_NEAR(sum_dB / places, 0, 0.3);
}

TEST(BinField, DoesNotJumpAlongAPipe) {
  const AcousticNetwork network{
      {{0, 1, 60, MakeIronWave()}}, {NodeEnd::kOpenWater, NodeEnd::kClosed}, {}, {}};
  BinField field(network, {{0, 22}}, MakeSpectra(1), kBin_Hz, {0});
  std::vector<float> before = SpectrumAt(field, 0, {0, 30});
  const double largest = 4 * std::pow(MakeIronWave().impedance_Pa_s_m3, 2);
  for (int i = 1; i < 3000; ++i) {
    const std::vector<float> psd = SpectrumAt(field, 0, {0, 30 + 1e-3 * i});
    for (std::size_t bin = 10; bin < 60; ++bin) {
      // 1 mm is 2 k dx <= 0.01 of a standing wave's phase
      ASSERT_LT(std::abs(psd[bin] - before[bin]), 0.02 * largest) << i << ", bin " << bin;
    }
    before = psd;
  }
}

}  // namespace
}  // namespace piperun::acoustics
