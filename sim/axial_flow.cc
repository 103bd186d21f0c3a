#include "sim/axial_flow.h"

namespace piperun::sim {

void AddStreamTerm(const StreamTerm& term, double r_m, AxialFlow& flow) {
  const Jet &w = term.weight_m3_s, &c = term.scale_1_m;
  const double c2 = c.value * c.value, cc1 = c.value * c.d1;
  flow.axial_m_s += w.value * c2 * term.slope;
  flow.radial_over_r_1_s -= w.d1 * c2 * term.mean + w.value * cc1 * term.slope;
  flow.d_axial_ds_1_s +=
      (w.d1 * c2 + 2 * w.value * cc1) * term.slope + w.value * c2 * c.d1 * r_m * term.shear;
  flow.d_axial_dr_1_s += w.value * c2 * c.value * term.shear;
  flow.d_radial_ds_1_s -= r_m * (w.d2 * c2 * term.mean +
                                 (2 * w.d1 * cc1 + w.value * (c.d1 * c.d1 + c.value * c.d2)) * term.slope +
                                 w.value * cc1 * c.d1 * r_m * term.shear);
}

}  // namespace piperun::sim
