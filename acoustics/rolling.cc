#include "acoustics/rolling.h"

#include "acoustics/level.h"

namespace piperun::acoustics {

double CalcRollingPsd(const RollingParams& params, double speed_m_s, double f_Hz) {
  if (speed_m_s <= 0) return 0;
  const double low = f_Hz / params.low_Hz, high = f_Hz / params.high_Hz;
  const double band = low * low / (1 + low * low) / (1 + high * high);
  return CalcPressureSquared(params.level_dB_re_1uPa2_Hz) * speed_m_s * speed_m_s * speed_m_s * band;
}

}  // namespace piperun::acoustics
