#include <cmath>
#include <numbers>

#include "acoustics/sound.h"
#include "base/check.h"

namespace piperun::acoustics::sounds::gas_pocket {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kAtmosphere_Pa = 101325;
constexpr double kHeatRatio = 1.4;  // of air
constexpr int kSizes = 64;          // 2.8 % apart from 0.5 to 3 mm: below the width of a bubble's line

struct GasPocketParams : ParamsOf<GasPocketParams> {
  double length_m = 2;
  double loss_dB_m = 3;
  double bubble_rate_Hz = 20;
  double min_radius_m = 5e-4;
  double max_radius_m = 3e-3;
  double relative_amplitude = 3e-4;
  double damping = 0.05;

  void Visit(ParamVisitor& v) override {
    v.Number({.name = "length_m", .doc = "of the stretch with air in it, centred on s_m"},
             {.min = 0, .max = 1000, .min_open = true}, length_m);
    v.Number({.name = "loss_dB_m", .doc = "extra loss of sound along that stretch, at all frequencies"},
             Range::Between(0, 1000), loss_dB_m);
    v.Number({.name = "bubble_rate_Hz", .doc = "how many bubbles break off and ring; 0: no hiss"},
             Range::Between(0, 1e6), bubble_rate_Hz);
    v.Number({.name = "min_radius_m", .doc = "of the smallest bubble; radii are log-uniform"},
             Range::Between(1e-5, 0.1), min_radius_m);
    v.Number({.name = "max_radius_m", .doc = "of the largest bubble"}, Range::Between(1e-5, 0.1),
             max_radius_m);
    v.Number({.name = "relative_amplitude", .doc = "of a bubble's radius as it begins to ring"},
             Range::Between(0, 0.1), relative_amplitude);
    v.Number({.name = "damping", .doc = "of a bubble: width of its line over its frequency"},
             Range::Between(0.005, 1), damping);
  }
};

/// Entrained air at a high point: bubbles that break off and ring. One of radius R at the absolute pressure p
/// rings at Minnaert's frequency (Phil. Mag. 16, 235 (1933)) with the volume velocity
///   q(t) = q_0 e^(-d w t/2) sin(w t),  w = (3 gamma p / rho)^(1/2) / R,  q_0 = w 4 pi R^3 e,
/// e the relative amplitude, d the damping. Independent bubbles, N per second, have the one-sided spectrum
/// (Campbell) S_q = 2 N <|Q|^2>, |Q|^2 = q_0^2 w^2 / ((w^2 + d^2 w^2/4 - W^2)^2 + d^2 w^2 W^2), W = 2 pi f,
/// mean over radii. 1 mm rings at 3.26 kHz under 1 bar. Engineering values, 15 dB either way: a millimetre
/// bubble born with e = 3e-4 makes about 1 Pa at 1 m in the open. The flow that carries them is not asked.
class BubbleHiss : public LeakSound {
 public:
  BubbleHiss(const GasPocketParams& p, const SoundSite& site)
      : bubble_rate_Hz_(p.bubble_rate_Hz), damping_(p.damping) {
    const double pressure_Pa = kAtmosphere_Pa + site.gauge_pressure_Pa;
    const double speed_m_s = std::sqrt(3 * kHeatRatio * pressure_Pa / site.water.density_kg_m3);
    for (int i = 0; i < kSizes; ++i) {
      const double radius_m = p.min_radius_m * std::pow(p.max_radius_m / p.min_radius_m, (i + 0.5) / kSizes);
      const double w_rad_s = speed_m_s / radius_m;
      const double volume_m3 = 4 * kPi * radius_m * radius_m * radius_m * p.relative_amplitude;
      sizes_.push_back({w_rad_s, w_rad_s * volume_m3});
    }
  }

  double VolumeVelocityPsd(double f_Hz) const override {
    const double W2 = 4 * kPi * kPi * f_Hz * f_Hz;
    double sum = 0;
    for (const Size& size : sizes_) {
      const double w2 = size.w_rad_s * size.w_rad_s;
      const double d2 = damping_ * damping_;
      const double detuning = w2 * (1 + d2 / 4) - W2;
      sum += size.peak_m3_s * size.peak_m3_s * w2 / (detuning * detuning + d2 * w2 * W2);
    }
    return 2 * bubble_rate_Hz_ * sum / kSizes;
  }

 private:
  struct Size {
    double w_rad_s;
    double peak_m3_s;
  };
  double bubble_rate_Hz_;
  double damping_;
  std::vector<Size> sizes_;
};

SiteSound Make(const Params& params, const SoundSite& site) {
  const auto& p = dynamic_cast<const GasPocketParams&>(params);
  if (p.min_radius_m > p.max_radius_m) {
    throw InputError("the smallest bubble is larger than the largest", "min_radius_m");
  }
  if (site.gauge_pressure_Pa <= -kAtmosphere_Pa) throw InputError("the pipe has no pressure here", "s_m");
  SiteSound sound;
  sound.role = Role::kGasPocket;
  sound.loss_length_m = p.length_m;
  sound.loss_Np_m = p.loss_dB_m * std::numbers::ln10 / 20;
  if (p.bubble_rate_Hz > 0) sound.noise = std::make_shared<BubbleHiss>(p, site);
  return sound;
}

}  // namespace

SoundKind Kind() {
  return {"gas_pocket", "entrained air at a high point: the hiss of its bubbles, and a loss along its length",
          MakeParams<GasPocketParams>, Make};
}

}  // namespace piperun::acoustics::sounds::gas_pocket
