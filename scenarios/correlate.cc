#include "scenarios/correlate.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "acoustics/pipe_wave.h"
#include "acoustics/sound_file.h"
#include "base/check.h"
#include "base/number.h"
#include "base/water.h"
#include "scenarios/materials.h"
#include "scenarios/svg_panel.h"

namespace piperun::scenarios {
namespace {

constexpr double kBeyondTravelTime = 1.1;  // delays that are looked at

void RequirePositive(double value, const std::string& key) {
  if (value > 0 && std::isfinite(value)) return;
  throw InputError(FormatNumber(value) + " is not allowed; it must be a finite number > 0", key);
}

void RequireNotNegative(double value, const std::string& key) {
  if (value >= 0 && std::isfinite(value)) return;
  throw InputError(FormatNumber(value) + " is not allowed; it must be a finite number >= 0", key);
}

double CalcSpeed_m_s(const CorrelateOptions& options) {
  if (options.speed_m_s) {
    RequirePositive(*options.speed_m_s, "speed_m_s");
    return *options.speed_m_s;
  }
  if (!options.pipe)
    throw InputError("say the speed of sound, or material, bore and wall of the pipe", "speed_m_s");
  const CorrelatePipe& pipe = *options.pipe;
  const WallParams wall = FindWall(pipe.material, {});
  const WallMaterial material{pipe.material,      wall.young_modulus_Pa, wall.loss_factor,
                              wall.poisson_ratio, wall.density_kg_m3,    wall.roughness_m};
  return acoustics::CalcPipeWave(pipe.diameter_m, pipe.wall_thickness_m, material, CalcWater(pipe.water_C))
      .speed_m_s;
}

std::vector<float> ReadAll(acoustics::SoundFile& file) {
  std::vector<float> record;
  std::vector<double> block(1 << 16);
  while (const std::size_t n = file.Read(block)) {
    for (std::size_t i = 0; i < n; ++i) record.push_back(static_cast<float>(block[i]));
  }
  return record;
}

void RequireOneRate(const acoustics::SoundFile& a, const acoustics::SoundFile& b) {
  if (a.rate_Hz() == b.rate_Hz()) return;
  throw InputError("has " + FormatNumber(b.rate_Hz()) + " samples per second, the other record " +
                       FormatNumber(a.rate_Hz()) + "; resample one of them",
                   "b");
}

}  // namespace

Correlation Correlate(const CorrelateOptions& options) {
  RequirePositive(options.distance_m, "distance_m");
  RequireNotNegative(options.distance_sd_m, "distance_sd_m");
  RequireNotNegative(options.speed_sd, "speed_sd");
  acoustics::SoundFile file_a(options.audio[0]), file_b(options.audio[1]);
  RequireOneRate(file_a, file_b);
  Correlation result;
  result.rate_Hz = file_a.rate_Hz();
  result.distance_m = options.distance_m;
  result.speed_m_s = CalcSpeed_m_s(options);
  for (std::size_t i = 0; i < 2; ++i) result.audio[i] = options.audio[i].filename().string();
  const std::vector<float> a = ReadAll(file_a), b = ReadAll(file_b);
  result.duration_s = static_cast<double>(std::min(a.size(), b.size())) / result.rate_Hz;
  const estimator::SoundWay way{
      {{options.distance_m, result.speed_m_s}}, options.distance_sd_m, options.speed_sd};
  estimator::CorrelationOptions how;
  how.weight = options.weight;
  how.band_low_Hz = options.band_low_Hz;
  how.band_high_Hz = options.band_high_Hz;
  how.max_delay_s = kBeyondTravelTime * estimator::CalcTravelTime_s(way);
  result.delay = estimator::EstimateDelay(a, b, result.rate_Hz, how);
  result.leak = estimator::LocateBetween(way, result.delay.delay_s, result.delay.sigma_s);
  return result;
}

std::string WriteCorrelationJson(const Correlation& correlation) {
  using Json = nlohmann::ordered_json;
  const estimator::DelayEstimate& delay = correlation.delay;
  const estimator::LeakBetween& leak = correlation.leak;
  const auto if_found = [&](const Json& value) { return delay.correlated ? value : Json(); };
  const Json json{{"schema", "piperun.correlate/1"},
                  {"a", correlation.audio[0]},
                  {"b", correlation.audio[1]},
                  {"rate_Hz", correlation.rate_Hz},
                  {"duration_s", correlation.duration_s},
                  {"distance_m", correlation.distance_m},
                  {"speed_m_s", correlation.speed_m_s},
                  {"band_Hz", Json::array({delay.band_low_Hz, delay.band_high_Hz})},
                  {"correlated", delay.correlated},
                  {"false_alarm", delay.false_alarm},
                  {"correlation", delay.correlation},
                  {"side_peak", delay.side_peak},
                  {"delay_s", if_found(delay.delay_s)},
                  {"delay_sigma_s", if_found(delay.sigma_s)},
                  {"from_a_m", if_found(leak.from_a_m)},
                  {"sigma_m", if_found(leak.sigma_m)},
                  {"interval_m", if_found(Json::array({leak.interval.low_m, leak.interval.high_m}))},
                  {"maybe_beyond", if_found(leak.maybe_beyond_a || leak.maybe_beyond_b)}};
  return json.dump(2) + "\n";
}

std::string DrawCorrelationSvg(const Correlation& correlation) {
  constexpr double kWidth = 1000, kPanel = 220, kLeft = 70, kTop = 50, kGap = 80;
  const estimator::DelayEstimate& delay = correlation.delay;
  // the place that a lag stands for: (d - c t) / 2 from a, so lags run backwards
  std::vector<double> place_m, frequency_Hz, coherence;
  for (const double lag_s : delay.lag_s)
    place_m.push_back(0.5 * (correlation.distance_m - correlation.speed_m_s * lag_s));
  for (std::size_t k = 1; k < delay.spectra.bins(); ++k) {
    frequency_Hz.push_back(delay.spectra.bin_width_Hz * static_cast<double>(k));
    coherence.push_back(delay.spectra.Coherence(k));
  }
  const SvgAxis x = MakeSvgAxis(place_m, kLeft, kWidth - 20);
  const SvgAxis y{std::min(0.0, *std::min_element(delay.curve.begin(), delay.curve.end())), 1, kTop + kPanel,
                  kTop};
  std::string svg = DrawSvgText(
      kLeft, kTop - 30, "Correlation against the place it stands for, metres from a", "font-size=\"13\"");
  svg += DrawSvgGrid(x, y, 2) + DrawSvgCurve(x, y, place_m, delay.curve);
  for (const auto& [at_m, name] : {std::pair{0.0, "a"}, std::pair{correlation.distance_m, "b"}})
    svg += DrawSvgText(x.At(at_m), kTop - 6, name, "text-anchor=\"middle\" font-weight=\"bold\"");
  if (delay.correlated) svg += DrawSvgMark(x.At(correlation.leak.from_a_m), y);
  const double top = kTop + kPanel + kGap;
  const SvgAxis f = MakeSvgAxis(frequency_Hz, kLeft, kWidth - 20), c{0, 1, top + kPanel, top};
  svg += DrawSvgText(kLeft, top - 12, "Coherence against frequency, Hz", "font-size=\"13\"");
  svg += DrawSvgGrid(f, c, 2) + DrawSvgCurve(f, c, frequency_Hz, coherence);
  return DrawSvg(kWidth, top + kPanel + 40, svg);
}

}  // namespace piperun::scenarios
