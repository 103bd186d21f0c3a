#include <complex>
#include <string>
#include <vector>

#include "acoustics/hydrophone.h"
#include "acoustics/level.h"
#include "acoustics/network_field.h"
#include "base/check.h"
#include "base/number.h"

namespace piperun::acoustics {
namespace {

void RequireBand(double f_low_Hz, double f_high_Hz, double rate_Hz) {
  if (f_low_Hz > 0 && f_low_Hz < f_high_Hz && f_high_Hz <= 0.5 * rate_Hz) return;
  throw InputError("the band " + FormatNumber(f_low_Hz) + " to " + FormatNumber(f_high_Hz) +
                       " Hz is not allowed; it must rise from above 0 to at most half the rate, " +
                       FormatNumber(0.5 * rate_Hz) + " Hz",
                   "band_Hz");
}

}  // namespace

double CalcLeakSnr_dB(const AcousticScene& scene, std::size_t leak, const HydrophoneParams& params,
                      const ListenerState& listener, double f_low_Hz, double f_high_Hz) {
  Demand(leak < scene.leaks.size(), "the scene has that leak");
  RequireBand(f_low_Hz, f_high_Hz, params.rate_Hz);
  const SoundingLeak& sounding = scene.leaks[leak];
  constexpr int kCells = 512;  // midpoint rule: 1e-4 for a power law of the third order over three decades
  const double cell_Hz = (f_high_Hz - f_low_Hz) / kCells;
  std::vector<double> frequencies_Hz;
  for (int i = 0; i < kCells; ++i) frequencies_Hz.push_back(f_low_Hz + (i + 0.5) * cell_Hz);
  const NetworkField field(scene.network, {sounding.place()}, frequencies_Hz);
  double signal = 0, noise = 0;
  for (std::size_t i = 0; i < frequencies_Hz.size(); ++i) {
    const double f_Hz = frequencies_Hz[i], gain = CalcHighPassGain(params, f_Hz);
    signal += gain * CalcLeakPsd(scene, sounding, field.Impedance_Pa_s_m3(i, 0, listener.place()),
                                 listener.place(), f_Hz);
    noise += gain * CalcBackgroundPsd(scene, listener, params.face_radius_m, f_Hz) +
             CalcSelfNoisePsd(params, f_Hz) + CalcConverterNoisePsd(params);
  }
  return CalcLevel_dB(signal) - CalcLevel_dB(noise);
}

}  // namespace piperun::acoustics
