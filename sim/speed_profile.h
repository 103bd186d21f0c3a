#pragma once

namespace piperun::sim {

/// Distance, speed and acceleration along a path at an instant.
struct PathPoint {
  double s_m = 0;
  double v_m_s = 0;
  double a_m_s2 = 0;
};

/// From rest to rest over a distance: speed rises as V (10 x^3 - 15 x^4 + 6 x^5), x = t / ramp, stays at V,
/// and falls likewise; its first and second derivatives are continuous (Flash & Hogan's minimum-jerk
/// polynomial, J. Neurosci. 5, 1688 (1985), applied to speed).
class SpeedProfile {
 public:
  /// All positive, distance >= speed * ramp (the caller asks Fits).
  SpeedProfile(double distance_m, double speed_m_s, double ramp_s);

  static bool Fits(double distance_m, double speed_m_s, double ramp_s) {
    return distance_m >= speed_m_s * ramp_s;
  }
  double distance_m() const { return distance_m_; }
  double duration_s() const { return distance_m_ / speed_m_s_ + ramp_s_; }
  double ramp_s() const { return ramp_s_; }
  /// Before the start and after the end at rest.
  PathPoint Eval(double t_s) const;

 private:
  double distance_m_;
  double speed_m_s_;
  double ramp_s_;
};

}  // namespace piperun::sim
