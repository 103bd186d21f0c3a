#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "acoustics/hydrophone.h"
#include "acoustics/scene.h"
#include "estimator/leak_locator.h"

namespace piperun::scenarios::detectors {

/// A leak of a survey, as loud as asked for.
struct SurveyLeak {
  double chainage_m = 0;
  double snr_dB = 0;       ///< leak over background without drift, 1 to 4 kHz, at the hole
  double loudness_dB = 0;  ///< how much louder it is than most leaks of its flow
};

/// A turbulent jet through a round hole.
struct Jet {
  double flow_m3_s = 1e-3 / 60;
  double pressure_Pa = 3e5;  ///< inside minus outside
  double loudness_dB = 0;    ///< of its fluctuation over the default 0.002 of its flow
};

/// What else is heard.
struct Disturbances {
  double common_drift_dB = 2;  ///< standard deviation, of all bands alike
  double band_drift_dB = 0.7;  ///< standard deviation, of the bands below and above 1 kHz, each for itself
  double drift_length_m = 20;
  double joint_spacing_m = 6;
  double joint_share = 0.7;         ///< of the joints that the ball hits
  double joint_impulse_N_s = 0.02;  ///< rings some 8 dB over the default background, 1 to 4 kHz
  double joint_spread_dB = 3;       ///< standard deviation
  double tone_Hz = 298;             ///< a pump's vane passing
  double tone_dB_re_1uPa = 105;
  double valve_snr_dB = 20;  ///< of a throttled valve 5 m behind the pipe's end, as a leak's
};

/// A straight pipe that a ball passes at 0.5 m/s, its speed swinging slowly by a tenth.
struct Survey {
  std::string pipe;  ///< what to call it
  WallMaterial wall;
  double bore_m = 0.15;
  double wall_thickness_m = 0.0075;
  double length_m = 1000;
  double rate_Hz = 16000;
  std::vector<SurveyLeak> leaks;
  Disturbances disturbances;
};

/// Chainage and its inverse are those of x(t) = v (t + 0.1 (1 - cos(w t)) / w), v = 0.5 m/s, w = 2 pi / 60 s.
double CalcSurveyChainage_m(double t_s);

/// Leak over the survey's background without drift, 1 to 4 kHz, at the hole: ratio of powers on the axis of
/// the ball, by acoustics::CalcLeakSnr_dB.
double CalcJetSnr_dB(const Survey& survey, const Jet& jet);

/// The jet of 3 bar and of that loudness whose sound at the hole stands snr_dB over the survey's background.
Jet MakeJetOfSnr(const Survey& survey, double snr_dB, double loudness_dB);

/// The map a crew would have of that pipe: all that is true but its leaks.
estimator::EstimatorStart MakeSurveyStart(const Survey& survey);

/// What a hydrophone records on the way, in its counts. Sound as acoustics::Hydrophone makes it (summed
/// spectrum frame by frame, knocks, converter), but that the background's level drifts along the way and a
/// pump's tone is added. Calls sink(block) for each block of a tenth of a second.
/// A pure function of (survey, seed, run).
using BlockSink = std::function<void(const AudioBlock&)>;
void RenderSurvey(const Survey& survey, std::uint64_t seed, std::uint64_t run, const BlockSink& sink);

/// Lets locators listen to the survey on the true trajectory.
void RunSurvey(const Survey& survey, std::uint64_t seed, std::uint64_t run,
               const std::vector<estimator::LeakLocator*>& locators);

}  // namespace piperun::scenarios::detectors
