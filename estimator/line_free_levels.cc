#include "estimator/line_free_levels.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include "base/check.h"
#include "estimator/real_fft.h"

namespace piperun::estimator {
namespace {

constexpr double kFall = 2.5;  // power of the frequency with which noise falls
constexpr double kIndependentShare = 1 / 1.6;

}  // namespace

struct LineFreeLevels::Plan {
  Plan(std::size_t even_samples, double rate_Hz)
      : fft(even_samples),
        bin_Hz(rate_Hz / static_cast<double>(even_samples)),
        window(even_samples),
        weighted(even_samples),
        spectrum(even_samples / 2 + 1),
        flat(spectrum.size()) {
    sorted.reserve(flat.size());
    double energy = 0;
    for (std::size_t i = 0; i < even_samples; ++i) {
      const double turn = (static_cast<double>(i) + 0.5) / static_cast<double>(even_samples);
      window[i] = static_cast<float>(0.5 - 0.5 * std::cos(2 * std::numbers::pi * turn));
      energy += static_cast<double>(window[i] * window[i]);
    }
    scale = 2 / (rate_Hz * energy);
    for (std::size_t k = 0; k < flat.size(); ++k) flat[k] = std::pow(static_cast<double>(k) * bin_Hz, kFall);
    density.resize(flat.size());
    power.resize(flat.size());
  }

  std::size_t First(double low_Hz) const { return static_cast<std::size_t>(std::ceil(low_Hz / bin_Hz)); }
  std::size_t Last(double high_Hz) const {
    return std::min(static_cast<std::size_t>(high_Hz / bin_Hz), flat.size() - 1);
  }

  RealFft fft;
  double bin_Hz;
  std::vector<float> window, weighted;
  std::vector<std::complex<float>> spectrum;
  double scale = 0;             // makes |X_k|^2 a density
  std::vector<double> density;  // P_k
  std::vector<double> flat;     // f_k^2.5
  std::vector<double> power;    // their product
  std::vector<double> sorted;   // scratch
};

LineFreeLevels::LineFreeLevels(std::size_t samples, double rate_Hz)
    : plan_(std::make_unique<Plan>(std::max<std::size_t>(2, samples / 2 * 2), rate_Hz)) {}
LineFreeLevels::~LineFreeLevels() = default;
LineFreeLevels::LineFreeLevels(LineFreeLevels&&) noexcept = default;
LineFreeLevels& LineFreeLevels::operator=(LineFreeLevels&&) noexcept = default;

bool LineFreeLevels::Resolves(double low_Hz, double high_Hz) const {
  return plan_->First(low_Hz) <= plan_->Last(high_Hz);
}

void LineFreeLevels::Transform(std::span<const float> frame_Pa) {
  Plan& p = *plan_;
  Demand(frame_Pa.size() >= p.window.size(), "a frame fills its transform");
  for (std::size_t i = 0; i < p.window.size(); ++i) p.weighted[i] = p.window[i] * frame_Pa[i];
  p.fft.Forward(p.weighted, p.spectrum);
  for (std::size_t k = 0; k < p.power.size(); ++k) {
    const auto re = static_cast<double>(p.spectrum[k].real()), im = static_cast<double>(p.spectrum[k].imag());
    p.density[k] = p.scale * (re * re + im * im);
    p.power[k] = p.flat[k] * p.density[k];
  }
}

double LineFreeLevels::CalcMeanSquare_Pa2(double low_Hz, double high_Hz) {
  Plan& p = *plan_;
  Demand(Resolves(low_Hz, high_Hz), "a band holds a bin");
  const auto at = [&](std::size_t k) { return p.power.begin() + static_cast<std::ptrdiff_t>(k); };
  p.sorted.assign(at(p.First(low_Hz)), at(p.Last(high_Hz) + 1));
  const auto middle = p.sorted.begin() + static_cast<std::ptrdiff_t>(p.sorted.size() / 2);
  std::nth_element(p.sorted.begin(), middle, p.sorted.end());
  const double integral = (std::pow(low_Hz, 1 - kFall) - std::pow(high_Hz, 1 - kFall)) / (kFall - 1);
  return *middle / std::numbers::ln2 * integral;
}

double LineFreeLevels::CalcPower_Pa2(double low_Hz, double high_Hz) const {
  double sum = 0;
  for (std::size_t k = plan_->First(low_Hz); k <= plan_->Last(high_Hz); ++k) sum += plan_->density[k];
  return sum * plan_->bin_Hz;
}

double CalcLineFreeScatter_dB(double low_Hz, double high_Hz, double frame_s) {
  const double independent = kIndependentShare * (high_Hz - low_Hz) * frame_s;
  return 10 / std::numbers::ln10 / (std::numbers::ln2 * std::sqrt(independent));
}

}  // namespace piperun::estimator
