#include "sim/load_ranges.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

namespace piperun::sim {
namespace {

enum : std::size_t { kDrag, kWallFactor, kRollingDrag, kSpinTorque, kProfile };

constexpr double kUnlimited = std::numeric_limits<double>::infinity();
constexpr double kLaminarRe = 2300, kTurbulentRe = 4000;

/// In two digits, large numbers as 3.1e5.
std::string FormatTwoDigits(double x) {
  std::array<char, 32> text{};
  const auto format = x < 1000 ? std::chars_format::general : std::chars_format::scientific;
  const auto end = std::to_chars(text.data(), text.data() + text.size(), x, format, x < 1000 ? 2 : 1).ptr;
  std::string result(text.data(), static_cast<std::size_t>(end - text.data()));
  if (const auto zero = result.find(".0e"); zero != std::string::npos) result.erase(zero, 2);
  if (const auto plus = result.find("e+0"); plus != std::string::npos) result.erase(plus + 1, 2);
  return result;
}

}  // namespace

LoadRanges::LoadRanges(const FluidLoadCoefficients& c, const WaterProperties& water, ProfileLaw profile)
    : wall_gap_m_(c.rolling_drag ? c.radius_m : -1),
      bore_to_reynolds_s_m2_(2 / water.kinematic_viscosity_m2_s) {
  const DragLawInfo& drag = FindDragLaw(c.drag.law);
  const bool smooth = c.drag.crisis;
  const WallFactorLawInfo& wall = FindWallFactorLaw(c.wall_factor);
  const bool power_law = profile == ProfileLaw::kPowerLaw;
  watches_[kDrag] = {"drag: " + (smooth ? std::string(drag.name) + " is fitted for Re"
                                        : "C_D of rough spheres is known (Achenbach) for Re"),
                     "the ball reached Re", smooth ? drag.max_reynolds : 6e6};
  watches_[kWallFactor] = {"wall factor: " + std::string(wall.name) + " is fitted for d/D",
                           "the ball had d/D", wall.max_diameter_ratio};
  watches_[kRollingDrag] = {"rolling drag: Jan & Chen is used for Re", "the ball reached Re", 2e5};
  watches_[kSpinTorque] = {"spin torque: Dennis et al. and Sawatzki are used for Re_w",
                           "the ball reached Re_w", c.spin_factor > 0 ? 2e5 : kUnlimited};
  watches_[kProfile] = {power_law ? "profile: Nikuradse's power law is fitted for the pipe's Re"
                                  : "profile: the log law is measured for the pipe's Re",
                        "the pipe had Re", power_law ? 3.2e6 : 3.5e7};
}

void LoadRanges::Feed(const LoadNumbers& numbers, const WaterAtBall& water) {
  const auto take = [&](std::size_t watch, double x) {
    watches_[watch].most = std::max(watches_[watch].most, x);
  };
  const double pipe_reynolds = bore_to_reynolds_s_m2_ * water.bore_radius_m * std::abs(water.bulk_speed_m_s);
  take(kDrag, numbers.free_reynolds);
  take(kWallFactor, numbers.diameter_ratio);
  if (water.wall_gap_m < wall_gap_m_) take(kRollingDrag, numbers.reynolds);
  take(kSpinTorque, numbers.spin_reynolds);
  take(kProfile, pipe_reynolds);
  if (pipe_reynolds > kLaminarRe && pipe_reynolds < kTurbulentRe) {
    transitional_reynolds_ = std::max(transitional_reynolds_, pipe_reynolds);
  }
}

std::vector<std::string> LoadRanges::Sentences() const {
  std::vector<std::string> sentences;
  for (const Watch& watch : watches_) {
    if (watch.most <= watch.limit) continue;
    sentences.push_back(watch.law + " < " + FormatTwoDigits(watch.limit) + "; " + watch.number + " " +
                        FormatTwoDigits(watch.most));
  }
  if (transitional_reynolds_ > 0) {
    sentences.push_back(
        "flow: between Re 2300 and 4000 friction and profile are a blend of laminar and turbulent; "
        "the pipe had Re " +
        FormatTwoDigits(transitional_reynolds_));
  }
  return sentences;
}

}  // namespace piperun::sim
