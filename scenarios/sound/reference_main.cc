#include "scenarios/sound/reference_main.h"

#include <algorithm>

#include "base/check.h"
#include "base/water.h"

namespace piperun::scenarios::sound {
namespace {

using acoustics::AcousticScene;
using acoustics::Hydrophone;
using acoustics::HydrophoneParams;
using acoustics::LeakSound;
using acoustics::PipeWave;

constexpr double kLength_m = 400;

class BandSound : public LeakSound {
 public:
  BandSound(double psd, double f_low_Hz, double f_high_Hz)
      : psd_(psd), low_Hz_(f_low_Hz), high_Hz_(f_high_Hz) {}
  double VolumeVelocityPsd(double f_Hz) const override {
    return f_Hz >= low_Hz_ && f_Hz < high_Hz_ ? psd_ : 0;
  }

 private:
  double psd_, low_Hz_, high_Hz_;
};

}  // namespace

PipeWave MakePvcMain() {
  return acoustics::CalcPipeWave(0.1475, 0.0075, {"pvc_u", 3.5e9, 0.05, 0.4, 1400, 0}, CalcWater(10));
}

PipeWave MakeIronMain() {
  return acoustics::CalcPipeWave(0.158, 0.006, {"ductile_iron", 165e9, 0.02, 0.28, 7100, 0}, CalcWater(10));
}

std::shared_ptr<const LeakSound> MakeBandSound(double psd_m6_s2_Hz, double f_low_Hz, double f_high_Hz) {
  return std::make_shared<BandSound>(psd_m6_s2_Hz, f_low_Hz, f_high_Hz);
}

std::shared_ptr<const LeakSound> MakeJet(double flow_m3_s, double hole_diameter_m, double drop_Pa) {
  const auto& kinds = acoustics::LeakSoundKinds();
  const auto kind = std::ranges::find(kinds, "turbulent_jet", &acoustics::LeakSoundKind::name);
  Demand(kind != kinds.end(), "there is a turbulent jet");
  return kind->make(*kind->make_params(), hole_diameter_m, {flow_m3_s, drop_Pa}, CalcWater(10).density_kg_m3);
}

AcousticScene MakeQuietMain(const PipeWave& wave) {
  AcousticScene scene;
  scene.network = {
      {{0, 1, kLength_m, wave}}, {acoustics::NodeEnd::kGoesOn, acoustics::NodeEnd::kGoesOn}, {}, {}};
  scene.water = CalcWater(10);
  scene.ambient.distant_level_dB_re_1uPa2_Hz = -200;
  scene.ambient.distant_slope_dB_per_decade = 0;
  scene.ambient.flow_noise = false;
  return scene;
}

void AddLeak(AcousticScene& scene, const acoustics::PipePlace& place,
             std::shared_ptr<const LeakSound> sound) {
  const std::string id = "L" + std::to_string(scene.leaks.size() + 1);
  scene.leaks.push_back({id, place.pipe, place.s_m, std::move(sound)});
}

HydrophoneParams MakeIdealHydrophone() {
  HydrophoneParams params;
  params.self_noise_dB_re_1uPa2_Hz = -200;
  params.high_pass_Hz = 0;
  return params;
}

Hydrophone::ListenerAt StandAt(double s_m) {
  return [s_m](TrueTime) {
    acoustics::ListenerState listener;
    listener.pipe = 0;
    listener.s_m = s_m;
    listener.water_speed_m_s = 0.5;
    listener.slip_speed_m_s = 0.05;
    listener.bore_radius_m = 0.07375;
    return listener;
  };
}

std::vector<float> Record(const AcousticScene& scene, const HydrophoneParams& params, std::uint64_t seed,
                          const Hydrophone::ListenerAt& listener, double seconds) {
  Hydrophone hydrophone(params, scene, RandomStream(seed, "hydrophone0", 0));
  std::vector<std::int32_t> block(static_cast<std::size_t>(params.block_samples));
  std::vector<float> pressure_Pa;
  for (auto left = static_cast<std::size_t>(seconds * params.rate_Hz); left > 0;) {
    block.resize(std::min(block.size(), left));
    hydrophone.Render(listener, block);
    for (const std::int32_t count : block)
      pressure_Pa.push_back(static_cast<float>(static_cast<double>(count) * params.scale_Pa()));
    left -= block.size();
  }
  return pressure_Pa;
}

double CalcMeanSquare(std::span<const float> x) {
  double sum = 0;
  for (const float value : x) sum += static_cast<double>(value) * static_cast<double>(value);
  return sum / static_cast<double>(x.size());
}

}  // namespace piperun::scenarios::sound
