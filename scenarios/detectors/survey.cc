#include "scenarios/detectors/survey.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <span>

#include "acoustics/gaussian_frames.h"
#include "acoustics/listener_spectrum.h"
#include "base/check.h"
#include "base/number.h"
#include "scenarios/detectors/slow_drift.h"
#include "scenarios/yaml_document.h"

namespace piperun::scenarios::detectors {
namespace {

constexpr double kSpeed_m_s = 0.5, kSwing = 0.1, kSwing_rad_s = 2 * std::numbers::pi / 60;
constexpr double kRelativeFluctuation = 2e-3;  // of a jet of loudness 0 dB
constexpr double kDischarge = 0.6;
constexpr double kBandLow_Hz = 1000, kBandHigh_Hz = 4000, kCrossover_Hz = 1000;
constexpr double kBeyond_m = 5;  // of the pipe's end: the valve
constexpr double kTemperature_C = 10;
constexpr std::size_t kFrame = 1024;

acoustics::HydrophoneParams MakeHydrophone(const Survey& survey) {
  acoustics::HydrophoneParams params;
  params.rate_Hz = survey.rate_Hz;
  return params;
}

const acoustics::LeakSoundKind& TurbulentJet() {
  const auto& kinds = acoustics::LeakSoundKinds();
  const auto jet =
      std::find_if(kinds.begin(), kinds.end(), [](const auto& k) { return k.name == "turbulent_jet"; });
  Demand(jet != kinds.end(), "there are turbulent jets");
  return *jet;
}

acoustics::SoundingLeak MakeJet(double s_m, const Jet& jet, const WaterProperties& water) {
  const double jet_m_s = std::sqrt(2 * jet.pressure_Pa / water.density_kg_m3);
  const double hole_m = std::sqrt(4 * jet.flow_m3_s / (std::numbers::pi * kDischarge * jet_m_s));
  const auto params = TurbulentJet().make_params();
  const double fluctuation = kRelativeFluctuation * std::pow(10, jet.loudness_dB / 20);
  const YamlDocument loud("relative_fluctuation: " + FormatNumber(fluctuation), "the detector study");
  loud.ReadSome([&](ParamVisitor& v) { params->Visit(v); });
  acoustics::SoundingLeak leak;
  leak.s_m = s_m;
  leak.sound = TurbulentJet().make(*params, hole_m, {jet.flow_m3_s, jet.pressure_Pa}, water.density_kg_m3);
  return leak;
}

/// The pipe, silent; its background alone sounds.
acoustics::AcousticScene MakeQuietScene(const Survey& survey) {
  acoustics::AcousticScene scene;
  scene.water = CalcWater(kTemperature_C);
  acoustics::AcousticPipe pipe;
  pipe.from_node = 0;
  pipe.to_node = 1;
  pipe.length_m = survey.length_m + 2 * kBeyond_m;
  pipe.wave = acoustics::CalcPipeWave(survey.bore_m, survey.wall_thickness_m, survey.wall, scene.water);
  scene.network.pipes.push_back(pipe);
  scene.network.ends = {acoustics::NodeEnd::kGoesOn, acoustics::NodeEnd::kGoesOn};
  return scene;
}

acoustics::ListenerState ListenerAt(const Survey& survey, double chainage_m) {
  return {0, chainage_m, kSpeed_m_s, 0.02, 0.5 * survey.bore_m};
}

/// Leaks and the valve.
acoustics::AcousticScene MakeSourceScene(const Survey& survey) {
  acoustics::AcousticScene scene = MakeQuietScene(survey);
  for (const SurveyLeak& leak : survey.leaks)
    scene.leaks.push_back(
        MakeJet(leak.chainage_m, MakeJetOfSnr(survey, leak.snr_dB, leak.loudness_dB), scene.water));
  const Jet valve = MakeJetOfSnr(survey, survey.disturbances.valve_snr_dB, 0);
  scene.leaks.push_back(MakeJet(survey.length_m + kBeyond_m, valve, scene.water));
  return scene;
}

/// Spectrum frame by frame: sources as they are, background times its drift.
class SurveySpectrum {
 public:
  SurveySpectrum(const Survey& survey, std::uint64_t seed, std::uint64_t run, double bin_Hz, std::size_t bins)
      : survey_(survey),
        all_(MakeSourceScene(survey), MakeHydrophone(survey), bin_Hz, bins),
        quiet_(MakeQuietScene(survey), MakeHydrophone(survey), bin_Hz, bins),
        common_(survey.disturbances.common_drift_dB, survey.disturbances.drift_length_m,
                RandomStream(seed, "survey_drift", run)),
        low_(survey.disturbances.band_drift_dB, survey.disturbances.drift_length_m,
             RandomStream(seed, "survey_drift_low", run)),
        high_(survey.disturbances.band_drift_dB, survey.disturbances.drift_length_m,
              RandomStream(seed, "survey_drift_high", run)),
        crossover_bin_(static_cast<std::size_t>(kCrossover_Hz / bin_Hz)),
        background_(bins) {}

  void Calc(double chainage_m, std::span<float> psd) {
    const auto listener = ListenerAt(survey_, chainage_m);
    all_.Calc(listener, psd);
    quiet_.Calc(listener, background_);
    const double common_dB = common_.Eval_dB(chainage_m);
    const auto low = static_cast<float>(std::pow(10, 0.1 * (common_dB + low_.Eval_dB(chainage_m))) - 1);
    const auto high = static_cast<float>(std::pow(10, 0.1 * (common_dB + high_.Eval_dB(chainage_m))) - 1);
    // psd >= background but for rounding: what is left of it stays positive
    for (std::size_t k = 0; k < psd.size(); ++k)
      psd[k] = std::max(psd[k] + (k < crossover_bin_ ? low : high) * background_[k], 0.F);
  }

 private:
  const Survey& survey_;
  acoustics::ListenerSpectrum all_, quiet_;
  SlowDrift common_, low_, high_;
  std::size_t crossover_bin_;
  std::vector<float> background_;
};

/// The inverse of CalcSurveyChainage_m by Newton's method; the speed is never below 0.45 m/s.
double CalcSurveyTime_s(double chainage_m) {
  double t_s = chainage_m / kSpeed_m_s;
  for (int i = 0; i < 8; ++i) {
    const double speed_m_s = kSpeed_m_s * (1 + kSwing * std::sin(kSwing_rad_s * t_s));
    t_s -= (CalcSurveyChainage_m(t_s) - chainage_m) / speed_m_s;
  }
  return t_s;
}

/// The blows at the pipe's joints, told to the sound of impacts as the ball comes to them.
class Joints {
 public:
  Joints(const Survey& survey, const RandomStream& random) {
    const Disturbances& d = survey.disturbances;
    if (!(d.joint_spacing_m > 0)) return;
    const auto joints = static_cast<std::uint64_t>(survey.length_m / d.joint_spacing_m);
    for (std::uint64_t i = 1; i < joints; ++i) {
      if (random.Uniforms(i, 0)[0] > d.joint_share) continue;
      const double excess_dB = d.joint_spread_dB * random.Normals(i, 1)[0];
      const double t_s = CalcSurveyTime_s(d.joint_spacing_m * static_cast<double>(i));
      knocks_.push_back(
          {TrueTime(FromSeconds(t_s)), d.joint_impulse_N_s * std::pow(10, excess_dB / 20), 0.001});
    }
  }
  void TellUpTo(TrueTime time, acoustics::ImpactSound& impacts) {
    for (; next_ < knocks_.size() && knocks_[next_].time <= time; ++next_) impacts.Add(knocks_[next_]);
  }

 private:
  std::vector<acoustics::Knock> knocks_;
  std::size_t next_ = 0;
};

/// A steady tone: its phase is that of the sample at the beginning of a block, and turned from there.
class Tone {
 public:
  Tone(const Disturbances& d, double rate_Hz)
      : amplitude_Pa_(std::sqrt(2.0) * 1e-6 * std::pow(10, d.tone_dB_re_1uPa / 20)),
        step_rad_(2 * std::numbers::pi * d.tone_Hz / rate_Hz),
        turn_(std::polar(1.0, step_rad_)) {}
  void AddTo(std::int64_t first_sample, std::span<float> pressure_Pa) const {
    auto phasor = std::polar(amplitude_Pa_, step_rad_ * static_cast<double>(first_sample));
    for (float& pressure : pressure_Pa) {
      pressure += static_cast<float>(phasor.real());
      phasor = {phasor.real() * turn_.real() - phasor.imag() * turn_.imag(),
                phasor.real() * turn_.imag() + phasor.imag() * turn_.real()};
    }
  }

 private:
  double amplitude_Pa_, step_rad_;
  std::complex<double> turn_;
};

}  // namespace

double CalcSurveyChainage_m(double t_s) {
  return kSpeed_m_s * (t_s + kSwing * (1 - std::cos(kSwing_rad_s * t_s)) / kSwing_rad_s);
}

double CalcJetSnr_dB(const Survey& survey, const Jet& jet) {
  acoustics::AcousticScene scene = MakeQuietScene(survey);
  const auto listener = ListenerAt(survey, 0.5 * survey.length_m);
  scene.leaks = {MakeJet(listener.s_m, jet, scene.water)};
  return acoustics::CalcLeakSnr_dB(scene, 0, MakeHydrophone(survey), listener, kBandLow_Hz, kBandHigh_Hz);
}

Jet MakeJetOfSnr(const Survey& survey, double snr_dB, double loudness_dB) {
  Jet jet;
  jet.loudness_dB = loudness_dB;
  for (int i = 0; i < 20; ++i) {  // the level grows as the flow, nearly; the corner moves with the hole
    const double off_dB = snr_dB - CalcJetSnr_dB(survey, jet);
    jet.flow_m3_s *= std::pow(10, off_dB / 20);
    if (std::abs(off_dB) < 1e-6) break;
  }
  return jet;
}

estimator::EstimatorStart MakeSurveyStart(const Survey& survey) {
  PipeSpec pipe;
  pipe.id = "P1";
  pipe.from = "A";
  pipe.to = "B";
  pipe.diameter_m = survey.bore_m;
  pipe.wall_thickness_m = survey.wall_thickness_m;
  pipe.material = survey.wall;
  Network network({{"A", {0, 0, 0}}, {"B", {survey.length_m, 0, 0}}}, {pipe});
  Route route(network, {{0, false}});
  estimator::EstimatorStart start;
  start.map = estimator::RouteMap{std::move(network), std::move(route)};
  return start;
}

void RenderSurvey(const Survey& survey, std::uint64_t seed, std::uint64_t run, const BlockSink& sink) {
  const acoustics::HydrophoneParams params = MakeHydrophone(survey);
  const Rate rate(survey.rate_Hz);
  acoustics::GaussianFrames frames(kFrame, survey.rate_Hz, RandomStream(seed, "survey", run));
  SurveySpectrum spectrum(survey, seed, run, frames.bin_width_Hz(), frames.bins());
  const acoustics::AcousticScene scene = MakeQuietScene(survey);
  acoustics::ImpactSound impacts(scene.ambient.impacts, scene.ball, scene.water.density_kg_m3, rate,
                                 params.high_pass_Hz, RandomStream(seed, "survey_knocks", run));
  Joints joints(survey, RandomStream(seed, "survey_joints", run));
  const Tone tone(survey.disturbances, survey.rate_Hz);
  std::vector<float> psd(frames.bins()), pressure_Pa(frames.hop());
  std::vector<std::int32_t> counts(frames.hop());
  const double largest = static_cast<double>(params.largest_code()), scale_Pa = params.scale_Pa();
  const auto hop = static_cast<std::int64_t>(frames.hop());
  const auto hops = static_cast<std::int64_t>(CalcSurveyTime_s(survey.length_m) * survey.rate_Hz) / hop;
  for (std::int64_t frame = 0; frame <= hops; ++frame) {
    spectrum.Calc(CalcSurveyChainage_m(Seconds(SampleTime(frame * hop, rate))), psd);
    const auto gaussian = frames.Advance(frame, psd);
    if (frame == 0) continue;
    std::copy(gaussian.begin(), gaussian.end(), pressure_Pa.begin());
    tone.AddTo((frame - 1) * hop, pressure_Pa);
    joints.TellUpTo(SampleTime(frame * hop, rate), impacts);
    impacts.Render(pressure_Pa);
    for (std::size_t i = 0; i < counts.size(); ++i) {
      const double code = static_cast<double>(pressure_Pa[i]) / scale_Pa;
      counts[i] = static_cast<std::int32_t>(std::lrint(std::clamp(code, -largest, largest)));
    }
    sink({RobotTime(SampleOffset(frame * hop - 1, rate)), survey.rate_Hz, scale_Pa, counts});
  }
}

void RunSurvey(const Survey& survey, std::uint64_t seed, std::uint64_t run,
               const std::vector<estimator::LeakLocator*>& locators) {
  estimator::NavState nav;
  nav.valid = true;
  nav.chainage_sd_m = 0.001;
  const auto tell = [&](RobotTime stamp) {
    nav.stamp = stamp;
    nav.chainage_m = CalcSurveyChainage_m(Seconds(stamp));
    nav.p_W = {nav.chainage_m, 0, 0};
    for (estimator::LeakLocator* locator : locators) locator->IngestNav(nav);
  };
  tell(RobotTime{});
  RenderSurvey(survey, seed, run, [&](const AudioBlock& block) {
    tell(block.stamp);
    for (estimator::LeakLocator* locator : locators) locator->IngestAudio(block);
  });
  for (estimator::LeakLocator* locator : locators) locator->Finish();
}

}  // namespace piperun::scenarios::detectors
