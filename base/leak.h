#pragma once

#include <string>

namespace piperun {

/// A hole in the wall of a pipe: what the truth knows. Estimators never see this type.
struct Leak {
  std::string id;
  int pipe = 0;
  double s_m = 0;  ///< along the pipe from its `from` node
  double hole_diameter_m = 0;
  double discharge_coefficient = 0.6;
  double area_slope_m = 0;  ///< dA/dh: area by which it grows per metre of pressure head (FAVAD)
};

/// The same leak once the water is flowing.
struct LeakState {
  double flow_m3_s = 0;
  double pressure_drop_Pa = 0;  ///< inside minus outside
};

}  // namespace piperun
