#include "sim/imu_filter.h"

#include <cmath>
#include <numbers>

#include "base/check.h"
#include "base/number.h"

namespace piperun::sim {
namespace {

constexpr std::array<std::string_view, 4> kDigital{"none", "boxcar", "low_pass_1", "low_pass_2"};

void RefuseAboveNyquist(double bandwidth_Hz, Rate rate, const std::string& key) {
  if (bandwidth_Hz < 0.5 * rate.Hz()) return;
  throw InputError("a low-pass of " + FormatNumber(bandwidth_Hz) + " Hz cannot run at the physics rate of " +
                       FormatNumber(rate.Hz()) +
                       " Hz; allowed: below half of that, so raise the motion's "
                       "rate_Hz or leave the filter out",
                   key);
}

}  // namespace

void ImuFilterParams::Visit(ParamVisitor& v) {
  v.NumberOr({"analogue_bandwidth_Hz", "-3 dB frequency of the low-pass in front of the converter."},
             Range::Positive(), "none", analogue_bandwidth_Hz);
  v.Integer({"analogue_order", "Its order; 2 is a Butterworth pair."}, 1, 2, analogue_order);
  v.Choice({"digital", "The chip's digital filter, at the physics rate: mean of the last taps, or low-pass."},
           kDigital, digital);
  v.Number({"digital_bandwidth_Hz", "-3 dB frequency of low_pass_1 and low_pass_2."}, Range::Positive(),
           digital_bandwidth_Hz);
  v.Integer({"digital_taps", "Length of the boxcar, in physics steps."}, 1, kMostTaps, digital_taps);
}

LowPass MakeLowPass(std::int64_t order, double bandwidth_Hz, Rate rate) {
  Demand(bandwidth_Hz > 0 && bandwidth_Hz < 0.5 * rate.Hz(), "a low-pass ends below half the rate");
  const double w = std::tan(std::numbers::pi * bandwidth_Hz / rate.Hz());
  if (order == 1) return {w / (1 + w), w / (1 + w), 0, (w - 1) / (1 + w), 0};
  Demand(order == 2, "a low-pass is of first or second order");
  const double norm = 1 / (1 + std::numbers::sqrt2 * w + w * w);
  const double b = w * w * norm;
  return {b, 2 * b, b, 2 * (w * w - 1) * norm, (1 - std::numbers::sqrt2 * w + w * w) * norm};
}

std::complex<double> CalcResponse(const LowPass& f, double frequency_Hz, Rate rate) {
  const auto z1 = std::polar(1.0, -2 * std::numbers::pi * frequency_Hz / rate.Hz());
  return (f.b0 + z1 * (f.b1 + z1 * f.b2)) / (1.0 + z1 * (f.a1 + z1 * f.a2));
}

LowPassState MakeSteady(const LowPass& f, const Vector3d& x) { return {(1 - f.b0) * x, (f.b2 - f.a2) * x}; }

BoxcarState MakeSteady(const Vector3d& x) {
  BoxcarState state;
  state.inputs.fill(x);
  return state;
}

Vector3d Step(BoxcarState& state, const Vector3d& x, std::size_t taps) {
  state.inputs[state.next] = x;
  state.next = (state.next + 1) % taps;
  Vector3d sum = Vector3d::Zero();
  for (std::size_t i = 0; i < taps; ++i) sum += state.inputs[i];
  return sum / static_cast<double>(taps);
}

ImuFilter MakeImuFilter(const ImuFilterParams& p, Rate rate) {
  ImuFilter filter;
  if (p.analogue_bandwidth_Hz) {
    RefuseAboveNyquist(*p.analogue_bandwidth_Hz, rate, "analogue_bandwidth_Hz");
    filter.has_analogue = true;
    filter.analogue = MakeLowPass(p.analogue_order, *p.analogue_bandwidth_Hz, rate);
  }
  if (p.digital == "boxcar") filter.taps = static_cast<std::size_t>(p.digital_taps);
  if (p.digital == "low_pass_1" || p.digital == "low_pass_2") {
    RefuseAboveNyquist(p.digital_bandwidth_Hz, rate, "digital_bandwidth_Hz");
    filter.has_digital = true;
    filter.digital = MakeLowPass(p.digital == "low_pass_1" ? 1 : 2, p.digital_bandwidth_Hz, rate);
  }
  return filter;
}

}  // namespace piperun::sim
