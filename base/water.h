#pragma once

namespace piperun {

/// Fresh water at atmospheric pressure.
struct WaterProperties {
  double temperature_C = 0;
  double density_kg_m3 = 0;
  double kinematic_viscosity_m2_s = 0;
  double sound_speed_m_s = 0;  ///< unconfined
};

/// Properties at a temperature, range 0 to 60 C (aborts outside):
/// density by Kell, J. Chem. Eng. Data 20, 97 (1975), eq. 16, 0.003 kg/m3 below today's tables;
/// viscosity by Kestin, Sokolov & Wakeham, J. Phys. Chem. Ref. Data 7, 941 (1978), 1002 uPa s at 20 C, within
/// 0.1 % of IAPWS 2008 up to 40 C and 0.3 % up to 60 C;
/// sound speed by Marczak, J. Acoust. Soc. Am. 102, 2776 (1997), within 0.05 m/s of Bilaniuk & Wong (1993).
WaterProperties CalcWater(double temperature_C);

}  // namespace piperun
