#pragma once

#include <string_view>

namespace piperun::scenarios {

// First lines of the files that are both written and read back.
inline constexpr std::string_view kImuHeader =
    "#timestamp [ns],w_RS_S_x [rad s^-1],w_RS_S_y [rad s^-1],w_RS_S_z [rad s^-1],"
    "a_RS_S_x [m s^-2],a_RS_S_y [m s^-2],a_RS_S_z [m s^-2]\n";
inline constexpr std::string_view kIncrementsHeader =
    "#timestamp [ns],dtheta_S_x [rad],dtheta_S_y [rad],dtheta_S_z [rad],"
    "dv_S_x [m s^-1],dv_S_y [m s^-1],dv_S_z [m s^-1]\n";
inline constexpr std::string_view kFlagsHeader = "#timestamp [ns],saturated [],duplicated []\n";
inline constexpr std::string_view kMagHeader = "#timestamp [ns],m_S_x [T],m_S_y [T],m_S_z [T]\n";
inline constexpr std::string_view kPressureHeader = "#timestamp [ns],pressure [Pa]\n";
inline constexpr std::string_view kTemperatureHeader = "#timestamp [ns],temperature [C]\n";
inline constexpr std::string_view kMarkerHeader = "#timestamp [ns],receiver [],x [m],y [m],z [m]\n";
inline constexpr std::string_view kBallHeader =
    "#timestamp [ns],pipe,s [m],chainage [m],p_WB_x [m],p_WB_y [m],p_WB_z [m],q_WB_w [],q_WB_x [],q_WB_y [],"
    "q_WB_z [],v_WB_x [m s^-1],v_WB_y [m s^-1],v_WB_z [m s^-1],w_WB_B_x [rad s^-1],w_WB_B_y [rad s^-1],"
    "w_WB_B_z [rad s^-1],f_WB_B_x [m s^-2],f_WB_B_y [m s^-2],f_WB_B_z [m s^-2],water_speed [m s^-1],contact "
    "[]\n";

}  // namespace piperun::scenarios
