#include "scenarios/sound_range.h"

#include <algorithm>
#include <cmath>

#include "acoustics/higher_modes.h"
#include "base/number.h"

namespace piperun::scenarios {
namespace {

constexpr double kLawHoldsTo = 0.15;  // ring frequencies: acoustics/pipe_wave.h
constexpr std::size_t kNamed = 3;

struct PipeClass {
  const acoustics::PipeWave* wave = nullptr;
  std::vector<std::string> ids;
};

std::vector<PipeClass> ListClasses(const Network& network, const acoustics::AcousticScene& scene) {
  std::vector<PipeClass> classes;
  for (const int pipe : scene.listening_pipes) {
    const acoustics::PipeWave& wave = scene.network.pipes[static_cast<std::size_t>(pipe)].wave;
    auto found =
        std::find_if(classes.begin(), classes.end(), [&](const PipeClass& c) { return *c.wave == wave; });
    if (found == classes.end()) found = classes.insert(classes.end(), PipeClass{&wave, {}});
    found->ids.push_back(network.pipe(pipe).id);
  }
  return classes;
}

/// "P1, P2, P3 and 12 more"
std::string NamePipes(const std::vector<std::string>& ids) {
  std::string names;
  for (std::size_t i = 0; i < std::min(ids.size(), kNamed); ++i) names += (i ? ", " : "") + ids[i];
  return ids.size() > kNamed ? names + " and " + std::to_string(ids.size() - kNamed) + " more" : names;
}

std::string Hertz(double f_Hz) { return FormatNumber(std::round(f_Hz)) + " Hz"; }

}  // namespace

std::vector<std::string> WarnOfSoundRange(const Network& network, const acoustics::AcousticScene& scene,
                                          double top_Hz) {
  std::vector<std::string> warnings;
  for (const PipeClass& c : ListClasses(network, scene)) {
    const double ring_Hz = c.wave->ring_frequency_Hz, holds_Hz = kLawHoldsTo * ring_Hz;
    const bool soft = c.wave->X > acoustics::kLargestCompliance;
    const std::string where = "sound: in " + NamePipes(c.ids);
    if (top_Hz > holds_Hz) {
      warnings.push_back(where + " the wave's law holds to " + Hertz(holds_Hz) + ", " +
                         FormatNumber(kLawHoldsTo) + " of the ring frequency " + Hertz(ring_Hz) +
                         "; the record goes to " + Hertz(top_Hz) + ", where true loss is higher");
    }
    if (top_Hz > c.wave->cut_on_Hz) {
      warnings.push_back(where + " the plane wave is alone to " + Hertz(c.wave->cut_on_Hz) +
                         ", the first cut-on; the record goes to " + Hertz(top_Hz) +
                         (soft ? ", and in a wall this soft no higher modes are told"
                               : ", and higher modes are heard only from leaks in the ball's own pipe"));
    }
  }
  return warnings;
}

}  // namespace piperun::scenarios
