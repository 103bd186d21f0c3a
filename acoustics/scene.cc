#include "acoustics/scene.h"

#include <algorithm>
#include <cmath>

#include "acoustics/flow_noise.h"
#include "acoustics/higher_modes.h"
#include "acoustics/near_field.h"
#include "acoustics/network_field.h"
#include "acoustics/rolling.h"
#include "base/check.h"

namespace piperun::acoustics {

double CalcLeakPsdAtHole(const AcousticScene& scene, const SoundingLeak& leak, double f_Hz) {
  Demand(leak.pipe >= 0 && static_cast<std::size_t>(leak.pipe) < scene.network.pipes.size(),
         "a leak is in a pipe");
  const PipeWave& wave = scene.network.pipes[static_cast<std::size_t>(leak.pipe)].wave;
  const double half_impedance = 0.5 * wave.CharacteristicImpedance_Pa_s_m3(f_Hz);
  return half_impedance * half_impedance * leak.sound->VolumeVelocityPsd(f_Hz);
}

double CalcLeakPsd(const AcousticScene& scene, const SoundingLeak& leak, const PipePlace& place,
                   double f_Hz) {
  const NetworkField field(scene.network, {leak.place()}, {f_Hz});
  return CalcLeakPsd(scene, leak, field.Impedance_Pa_s_m3(0, 0, place), place, f_Hz);
}

double CalcLeakPsd(const AcousticScene& scene, const SoundingLeak& leak,
                   const std::complex<double>& impedance_Pa_s_m3, const PipePlace& place, double f_Hz) {
  const double plane = std::norm(impedance_Pa_s_m3) * leak.sound->VolumeVelocityPsd(f_Hz);
  if (place.pipe != leak.pipe) return plane;
  const PipeWave& wave = scene.network.pipes[static_cast<std::size_t>(leak.pipe)].wave;
  const double z_m = place.s_m - leak.s_m;
  const double beside = CalcNearField(wave, z_m, f_Hz) +
                        CalcHigherModes(wave, CalcListeningRadius(scene.ball, wave.bore_radius_m), z_m, f_Hz);
  return plane + beside * CalcLeakPsdAtHole(scene, leak, f_Hz);
}

double CalcBackgroundPsd(const AcousticScene& scene, const ListenerState& listener, double face_radius_m,
                         double f_Hz) {
  const double rolling = CalcRollingPsd(scene.ambient.rolling, CalcRollingSpeed(scene, listener), f_Hz);
  const double distant = CalcDistantNoisePsd(scene.ambient, f_Hz) + rolling;
  const double speed_m_s = CalcEddySpeed(listener.slip_speed_m_s, listener.water_speed_m_s);
  if (!scene.ambient.flow_noise || listener.pipe < 0 || speed_m_s <= 0) return distant;
  const WallFlow flow = CalcWallFlow(speed_m_s, listener.bore_radius_m, scene.water);
  return distant + CalcWallPressurePsd(flow, f_Hz) * CalcFaceAveraging(flow, face_radius_m, f_Hz);
}

double CalcListeningRadius(const StruckBall& ball, double bore_radius_m) {
  return std::max(0.0, 1 - ball.radius_m / bore_radius_m);
}

double CalcRollingSpeed(const AcousticScene& scene, const ListenerState& listener) {
  const bool sounds = scene.ambient.rolling.on && !scene.ball.gives_way && listener.pipe >= 0;
  return sounds ? std::abs(listener.rolling_speed_m_s) : 0;
}

}  // namespace piperun::acoustics
