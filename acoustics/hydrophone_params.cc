#include <algorithm>
#include <cmath>
#include <string>

#include "acoustics/hydrophone.h"
#include "acoustics/level.h"
#include "base/check.h"
#include "base/number.h"

namespace piperun::acoustics {
namespace {

constexpr Range kRates_Hz{.min = 1000, .max = 384000};

}  // namespace

std::int64_t HydrophoneParams::largest_code() const { return (std::int64_t{1} << (bits - 1)) - 1; }

double HydrophoneParams::scale_Pa() const { return full_scale_Pa / static_cast<double>(largest_code()); }

void HydrophoneParams::Visit(ParamVisitor& v) {
  v.Number({.name = "rate_Hz", .doc = "sampling rate"}, kRates_Hz, rate_Hz);
  v.Integer({.name = "block_samples", .doc = "samples per audio block"}, 1, 1 << 24, block_samples);
  v.Integer({.name = "bits", .doc = "resolution of the converter: 16 or 24"}, 16, 24, bits);
  v.Number({.name = "full_scale_Pa", .doc = "pressure of the largest code"}, Range::Positive(),
           full_scale_Pa);
  v.Number({.name = "self_noise_dB_re_1uPa2_Hz",
            .doc = "spectral level of sensor and preamplifier noise at 1 kHz, flat above 100 Hz, 1/f below"},
           Range::Between(-200, 200), self_noise_dB_re_1uPa2_Hz);
  v.Number({.name = "high_pass_Hz", .doc = "-3 dB corner of the first-order input stage"},
           Range::NonNegative(), high_pass_Hz);
  v.Number({.name = "face_radius_m", .doc = "radius of the sensitive face, which averages small eddies away"},
           Range::Between(0, 0.1), face_radius_m);
  v.Flag({.name = "stems", .doc = "keep what each source contributes, in truth/stems"}, stems);
  v.Struct({.name = "faults", .doc = "what goes wrong with its record"}, faults);
}

void HydrophoneParams::Check() const {
  if (!kRates_Hz.Contains(rate_Hz) || rate_Hz != std::floor(rate_Hz)) {
    throw InputError(
        FormatNumber(rate_Hz) + " is not allowed; it must be a whole number in " + kRates_Hz.Text(),
        "rate_Hz");
  }
  if (bits != 16 && bits != 24) {
    throw InputError(std::to_string(bits) + " is not allowed; a converter has 16 or 24 bits", "bits");
  }
}

double CalcHighPassGain(const HydrophoneParams& params, double f_Hz) {
  const double f2 = f_Hz * f_Hz;
  return f2 / (f2 + params.high_pass_Hz * params.high_pass_Hz);
}

double CalcSelfNoisePsd(const HydrophoneParams& params, double f_Hz) {
  return CalcPressureSquared(params.self_noise_dB_re_1uPa2_Hz) * std::max(1.0, 100 / f_Hz);
}

double CalcConverterNoisePsd(const HydrophoneParams& params) {
  return params.scale_Pa() * params.scale_Pa() / (6 * params.rate_Hz);
}

}  // namespace piperun::acoustics
