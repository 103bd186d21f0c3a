// A leak near a tee: three equal mains meet, one of them a stub of 7 m that ends dead.

#include <cmath>

#include "acoustics/level.h"
#include "base/number.h"
#include "scenarios/output_file.h"
#include "scenarios/sound/groups.h"
#include "scenarios/sound/reference_main.h"

namespace piperun::scenarios::sound {
namespace {

constexpr double kTee_m = 200, kLeakBefore_m = 2, kReach_m = 6;

/// Pipe 0 up to the tee, pipe 1 on from it; the branch goes on for ever or ends dead after 7 m.
acoustics::AcousticScene MakeTee(bool dead_end) {
  const acoustics::PipeWave wave = MakePvcMain();
  acoustics::AcousticScene scene = MakeQuietMain(wave);
  using acoustics::NodeEnd;
  scene.network = {
      {{0, 1, kTee_m, wave}, {1, 2, 200, wave}, {1, 3, dead_end ? 7.0 : 200.0, wave}},
      {NodeEnd::kGoesOn, NodeEnd::kClosed, NodeEnd::kGoesOn, dead_end ? NodeEnd::kClosed : NodeEnd::kGoesOn},
      {},
      {}};
  AddLeak(scene, {0, kTee_m - kLeakBefore_m}, MakeJet(1e-4 / 60, 1.2e-3, 3e5));
  return scene;
}

/// Chainage 0 at the tee.
acoustics::ListenerState At(double chainage_m) {
  acoustics::ListenerState listener = StandAt(kTee_m + chainage_m)(TrueTime{});
  if (chainage_m > 0) listener.pipe = 1, listener.s_m = chainage_m;
  return listener;
}

double CalcBand_dB(acoustics::Hydrophone& hydrophone, double chainage_m, double low_Hz, double high_Hz) {
  std::vector<double> band_Pa2(2);
  hydrophone.CalcBandPower(At(chainage_m), low_Hz, high_Hz, band_Pa2);
  return acoustics::CalcLevel_dB(band_Pa2[0]);
}

constexpr double kWidth = 900, kHeight = 420, kLeft = 60, kTop = 40, kBottom = 370;

struct Curve {
  std::string name, colour;
  std::vector<double> level_dB;
};

std::string DrawCurves(const std::vector<double>& chainage_m, const std::vector<Curve>& curves) {
  double low = 1e9, high = -1e9;
  for (const Curve& curve : curves) {
    for (const double level : curve.level_dB) low = std::fmin(low, level), high = std::fmax(high, level);
  }
  low = 10 * std::floor(low / 10), high = 10 * std::ceil(high / 10);
  const auto x = [](double place_m) {
    return FormatFixed(kLeft + (place_m + kReach_m) / (2 * kReach_m) * (kWidth - kLeft - 30), 1);
  };
  const auto y = [=](double level) {
    return FormatFixed(kBottom - (level - low) / (high - low) * (kBottom - kTop), 1);
  };
  std::string svg =
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"900\" height=\"420\" "
      "font-family=\"sans-serif\" font-size=\"12\">\n<rect width=\"100%\" height=\"100%\" "
      "fill=\"white\"/>\n";
  for (double level = low; level <= high; level += 10) {
    svg += "<path d=\"M" + x(-kReach_m) + " " + y(level) + "H" + x(kReach_m) + "\" stroke=\"#ddd\"/>\n" +
           "<text x=\"52\" y=\"" + y(level) + "\" text-anchor=\"end\">" + FormatFixed(level, 0) + "</text>\n";
  }
  for (double place_m = -kReach_m; place_m <= kReach_m; place_m += 2)
    svg += "<text x=\"" + x(place_m) + "\" y=\"388\" text-anchor=\"middle\">" + FormatFixed(place_m, 0) +
           "</text>\n";
  for (const auto& [place_m, name] : {std::pair{0.0, "tee"}, std::pair{-kLeakBefore_m, "leak"}}) {
    svg += "<path d=\"M" + x(place_m) + " 40V370\" stroke=\"#999\" stroke-dasharray=\"4 3\"/>\n<text x=\"" +
           x(place_m) + "\" y=\"34\" text-anchor=\"middle\">" + name + "</text>\n";
  }
  double top = 60;
  for (const Curve& curve : curves) {
    svg += "<polyline fill=\"none\" stroke=\"" + curve.colour + "\" points=\"";
    for (std::size_t i = 0; i < chainage_m.size(); ++i)
      svg += x(chainage_m[i]) + "," + y(curve.level_dB[i]) + " ";
    svg += "\"/>\n<text x=\"620\" y=\"" + FormatFixed(top, 0) + "\" fill=\"" + curve.colour + "\">" +
           curve.name + "</text>\n";
    top += 16;
  }
  return svg +
         "<text x=\"450\" y=\"408\" text-anchor=\"middle\">m along the main from the tee</text>\n"
         "<text x=\"60\" y=\"18\" font-size=\"13\">Leak of 0.1 L/min before a tee in PVC DN150: level in "
         "the band, dB re 1 uPa</text>\n</svg>\n";
}

void Draw(acoustics::Hydrophone& open, acoustics::Hydrophone& dead, const std::filesystem::path& file) {
  std::vector<double> chainage_m;
  std::vector<Curve> curves{{"branch goes on, 1 to 4 kHz", "#1f77b4", {}},
                            {"branch ends dead after 7 m, 1 to 4 kHz", "#d62728", {}},
                            {"the same, 200 to 216 Hz: standing waves", "#2ca02c", {}}};
  for (int cm = -600; cm <= 600; ++cm) {
    const double place_m = 0.01 * cm;
    chainage_m.push_back(place_m);
    curves[0].level_dB.push_back(CalcBand_dB(open, place_m, 1000, 4000));
    curves[1].level_dB.push_back(CalcBand_dB(dead, place_m, 1000, 4000));
    curves[2].level_dB.push_back(CalcBand_dB(dead, place_m, 200, 216));
  }
  WriteTextFile(file, DrawCurves(chainage_m, curves));
}

}  // namespace

void CheckTee(const ReproduceOptions& options, ReproduceReport& report) {
  FigureChecks checks(report, "tee");
  const acoustics::HydrophoneParams params = MakeIdealHydrophone();
  acoustics::Hydrophone open(params, MakeTee(false), RandomStream(options.seed, "hydrophone0", 0));
  acoustics::Hydrophone dead(params, MakeTee(true), RandomStream(options.seed, "hydrophone0", 0));
  acoustics::AcousticScene plain_scene = MakeQuietMain(MakePvcMain());
  AddLeak(plain_scene, {0, kTee_m - kLeakBefore_m}, MakeJet(1e-4 / 60, 1.2e-3, 3e5));
  acoustics::Hydrophone plain(params, plain_scene, RandomStream(options.seed, "hydrophone0", 0));
  std::vector<double> without_Pa2(2), with_Pa2(2);
  plain.CalcBandPower(StandAt(kTee_m + 2)(TrueTime{}), 1000, 4000, without_Pa2);
  open.CalcBandPower(At(2), 1000, 4000, with_Pa2);
  checks.Near("what an equal tee takes from a leak's sound behind it [dB]",
              10 * std::log10(with_Pa2[0] / without_Pa2[0]), 20 * std::log10(2.0 / 3), 0.01,
              "T = 2 / 3 of three equal branches");
  if (!options.out.empty()) Draw(open, dead, options.out / "tee.svg");
}

}  // namespace piperun::scenarios::sound
