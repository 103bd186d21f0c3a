// A hydrophone that passes a hole: the roof of its level along the pipe.

#include <cmath>
#include <limits>

#include "acoustics/level.h"
#include "scenarios/sound/groups.h"
#include "scenarios/sound/reference_main.h"

namespace piperun::scenarios::sound {
namespace {

constexpr double kHole_m = 200.013, kReach_m = 3;
constexpr std::size_t kStretch = 512;

/// Levels of stretches of 32 ms, at the places of their middles.
struct Profile {
  std::vector<double> place_m, level_dB;
};

Profile RecordPassage(std::uint64_t seed, double speed_m_s) {
  acoustics::AcousticScene scene = MakeQuietMain(MakePvcMain());
  AddLeak(scene, {0, kHole_m}, MakeBandSound(1e-13, 2900, 3100));
  const double begin_m = kHole_m - kReach_m;
  const auto listener = [&](TrueTime t) { return StandAt(begin_m + speed_m_s * Seconds(t))(t); };
  const auto record = Record(scene, MakeIdealHydrophone(), seed, listener, 2 * kReach_m / speed_m_s);
  Profile profile;
  for (std::size_t n = 0; n + kStretch <= record.size(); n += kStretch) {
    profile.place_m.push_back(begin_m + speed_m_s * (static_cast<double>(n) + 0.5 * (kStretch - 1)) / 16000);
    profile.level_dB.push_back(
        acoustics::CalcLevel_dB(CalcMeanSquare(std::span(record).subspan(n, kStretch))));
  }
  return profile;
}

struct Roof {
  double slope_dB_m = 0, residual = 0;
};

/// Least squares of the level over |s - top|, but for a bore about the top, where the near field is.
Roof FitRoof(const Profile& profile, double top_m) {
  double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0, syy = 0;
  for (std::size_t i = 0; i < profile.level_dB.size(); ++i) {
    const double x = std::abs(profile.place_m[i] - top_m), y = profile.level_dB[i];
    if (x < 0.15) continue;
    n += 1, sx += x, sy += y, sxx += x * x, sxy += x * y, syy += y * y;
  }
  const double cov = sxy - sx * sy / n, var = sxx - sx * sx / n;
  return {cov / var, (syy - sy * sy / n - cov * cov / var) / n};
}

double FindTop_m(const Profile& profile) {
  double top_m = 0, least = std::numeric_limits<double>::infinity();
  for (int mm = -500; mm <= 500; ++mm) {
    const double candidate_m = kHole_m - 0.013 + 1e-3 * mm;
    const double residual = FitRoof(profile, candidate_m).residual;
    if (residual < least) least = residual, top_m = candidate_m;
  }
  return top_m;
}

}  // namespace

void CheckPassage(const ReproduceOptions& options, ReproduceReport& report) {
  FigureChecks checks(report, "passage");
  const int passes = std::max(1, static_cast<int>(std::lround(40 * options.size)));
  const double widening = std::sqrt(40.0 / passes);
  const double expected_dB_m = 8.685889638 * MakePvcMain().Attenuation_Np_m(3000);
  for (const double speed_m_s : {0.3, 1.0}) {
    double top_m = 0, slope_dB_m = 0;
    for (int pass = 0; pass < passes; ++pass) {
      const Profile profile = RecordPassage(options.seed + static_cast<std::uint64_t>(pass), speed_m_s);
      top_m += FindTop_m(profile) / passes;
      slope_dB_m -= FitRoof(profile, kHole_m).slope_dB_m / passes;
    }
    const std::string at =
        " at " + std::string(speed_m_s < 0.5 ? "0.3" : "1.0") + " m/s, mean of " + std::to_string(passes);
    checks.Near("top of the roof over the hole [m]," + at, top_m - kHole_m, 0, 0.02 * widening, "the hole");
    checks.Relative("slope of the roof outside a bore at 3 kHz [dB/m]," + at, slope_dB_m, expected_dB_m,
                    0.01 * widening, "attenuation of the formula");
  }
}

}  // namespace piperun::scenarios::sound
