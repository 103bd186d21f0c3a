#pragma once

#include <limits>
#include <memory>

#include "acoustics/hydrophone.h"
#include "base/params.h"

namespace piperun::acoustics {

inline WallMaterial MakeWall(double young_modulus_Pa, double loss_factor, double poisson_ratio = 0.4,
                             double density_kg_m3 = 1400) {
  return {"", young_modulus_Pa, loss_factor, poisson_ratio, density_kg_m3, 0};
}

inline WaterProperties MakeWater10C() { return CalcWater(10); }

/// PVC-U DN150: mean radius 77.5 mm, wall 7.5 mm.
inline constexpr double kPvcBore_m = 0.1475;
inline PipeWave MakePvcWave() {
  return CalcPipeWave(kPvcBore_m, 0.0075, MakeWall(3.5e9, 0.05), MakeWater10C());
}

/// Ductile iron DN150 K9: mean radius 82 mm, wall 6 mm.
inline PipeWave MakeIronWave() {
  return CalcPipeWave(0.158, 0.006, MakeWall(165e9, 0.02, 0.28, 7100), MakeWater10C());
}

/// The same with no loss in the wall: 0.003 dB in half a metre at 6 kHz.
inline PipeWave MakeStiffWave() {
  PipeWave wave = MakeIronWave();
  wave.loss_factor = 0;
  return wave;
}

/// A sound with a flat spectrum between two frequencies and none outside.
class FlatSound : public LeakSound {
 public:
  FlatSound(double psd, double f_low_Hz, double f_high_Hz)
      : psd_(psd), low_Hz_(f_low_Hz), high_Hz_(f_high_Hz) {}
  double VolumeVelocityPsd(double f_Hz) const override {
    return f_Hz >= low_Hz_ && f_Hz < high_Hz_ ? psd_ : 0;
  }

 private:
  double psd_, low_Hz_, high_Hz_;
};

inline constexpr double kPipe_m = 400;

/// Pipes that go on wherever one of them ends alone.
inline AcousticNetwork MakeNetwork(std::vector<AcousticPipe> pipes) {
  AcousticNetwork network;
  for (const AcousticPipe& pipe : pipes) {
    for (const int node : {pipe.from_node, pipe.to_node}) {
      const auto i = static_cast<std::size_t>(node);
      const bool met = i < network.ends.size() && network.ends[i] == NodeEnd::kGoesOn;
      if (i >= network.ends.size()) network.ends.resize(i + 1, NodeEnd::kOpenWater);
      network.ends[i] = met || network.ends[i] == NodeEnd::kClosed ? NodeEnd::kClosed : NodeEnd::kGoesOn;
    }
  }
  network.pipes = std::move(pipes);
  return network;
}

/// One pipe that goes on beyond its 400 m, without any background.
inline AcousticScene MakeQuietScene(const PipeWave& wave) {
  AcousticScene scene;
  scene.network = MakeNetwork({{0, 1, kPipe_m, wave}});
  scene.water = MakeWater10C();
  scene.ambient = {
      .distant_level_dB_re_1uPa2_Hz = -200, .distant_slope_dB_per_decade = 0, .flow_noise = false};
  return scene;
}

inline void AddLeak(AcousticScene& scene, const PipePlace& place, std::shared_ptr<const LeakSound> sound) {
  const std::string id = "L" + std::to_string(scene.leaks.size() + 1);
  scene.leaks.push_back({id, place.pipe, place.s_m, std::move(sound)});
}

/// A leak in the only pipe.
inline void AddLeak(AcousticScene& scene, double s_m, std::shared_ptr<const LeakSound> sound) {
  AddLeak(scene, PipePlace{0, s_m}, std::move(sound));
}

/// The spectrum of leak `i` at a place.
inline double CalcLeakPsdAt(const AcousticScene& scene, std::size_t i, const PipePlace& place, double f_Hz) {
  return CalcLeakPsd(scene, scene.leaks[i], place, f_Hz);
}

/// The turbulent jet with its default parameters.
inline std::shared_ptr<const LeakSound> MakeJet(double flow_m3_s, double hole_diameter_m,
                                                double drop_Pa = 3e5,
                                                double density_kg_m3 = MakeWater10C().density_kg_m3) {
  for (const LeakSoundKind& kind : LeakSoundKinds()) {
    if (kind.name != "turbulent_jet") continue;
    return kind.make(*kind.make_params(), hole_diameter_m, {flow_m3_s, drop_Pa}, density_kg_m3);
  }
  return nullptr;
}

inline HydrophoneParams MakeNoiselessHydrophone() {
  HydrophoneParams params;
  params.self_noise_dB_re_1uPa2_Hz = -200;
  params.high_pass_Hz = 0;
  return params;
}

/// `seconds` of pressure in pascals.
inline std::vector<double> RenderPressure(const AcousticScene& scene, const HydrophoneParams& params,
                                          const RandomStream& random, const Hydrophone::ListenerAt& listener,
                                          double seconds) {
  Hydrophone hydrophone(params, scene, random);
  std::vector<std::int32_t> counts(static_cast<std::size_t>(seconds * params.rate_Hz));
  hydrophone.Render(listener, counts);
  std::vector<double> pressure_Pa;
  pressure_Pa.reserve(counts.size());
  for (const std::int32_t c : counts) pressure_Pa.push_back(c * params.scale_Pa());
  return pressure_Pa;
}

inline Hydrophone::ListenerAt StillAt(double s_m) {
  return [=](TrueTime) { return ListenerState{0, s_m, 0.5, 0.05, kPvcBore_m / 2}; };
}

}  // namespace piperun::acoustics
