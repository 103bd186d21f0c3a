#include "scenarios/sound_range.h"

#include <algorithm>
#include <cmath>
#include <optional>

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

double CalcLawLimit_Hz(const acoustics::PipeWave& wave) { return kLawHoldsTo * wave.ring_frequency_Hz; }
double CalcCutOn_Hz(const acoustics::PipeWave& wave) { return wave.cut_on_Hz; }

/// The lowest of the limits that the record goes beyond.
struct Limit {
  double f_Hz = 0;
  const PipeClass* lowest = nullptr;
  std::size_t pipes = 0;  ///< all in which it goes beyond theirs
};

std::optional<Limit> FindLimit(const std::vector<PipeClass>& classes, double top_Hz,
                               double (*calc_limit_Hz)(const acoustics::PipeWave&)) {
  Limit limit{top_Hz};
  for (const PipeClass& c : classes) {
    const double f_Hz = calc_limit_Hz(*c.wave);
    if (top_Hz <= f_Hz) continue;
    limit.pipes += c.ids.size();
    if (f_Hz < limit.f_Hz) limit.f_Hz = f_Hz, limit.lowest = &c;
  }
  return limit.lowest ? std::optional(limit) : std::nullopt;
}

/// "527 Hz in P1, P2, P3 and 12 more, higher in 4 others"
std::string Describe(const Limit& limit) {
  const std::size_t others = limit.pipes - limit.lowest->ids.size();
  return Hertz(limit.f_Hz) + " in " + NamePipes(limit.lowest->ids) +
         (others > 0 ? ", higher in " + std::to_string(others) + " others" : "");
}

}  // namespace

std::vector<std::string> WarnOfSoundRange(const Network& network, const acoustics::AcousticScene& scene,
                                          double top_Hz) {
  const std::vector<PipeClass> classes = ListClasses(network, scene);
  std::vector<std::string> warnings;
  const std::string record = "sound: the record goes to " + Hertz(top_Hz);
  if (const auto law = FindLimit(classes, top_Hz, CalcLawLimit_Hz)) {
    warnings.push_back(record + ", the law of the wall to " + FormatNumber(kLawHoldsTo) +
                       " of the ring frequency: " + Describe(*law) + "; beyond, true loss is higher");
  }
  if (const auto cut_on = FindLimit(classes, top_Hz, CalcCutOn_Hz)) {
    warnings.push_back(record + ", the plane wave is alone to the first cut-on: " + Describe(*cut_on) +
                       "; beyond, higher modes are heard from leaks in the ball's own pipe if its wall is "
                       "stiffer than the water, else none");
  }
  return warnings;
}

}  // namespace piperun::scenarios
