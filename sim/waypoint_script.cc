#include "sim/waypoint_script.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "base/check.h"
#include "base/number.h"
#include "sim/yaw_pitch_roll.h"

namespace piperun::sim {
namespace {

constexpr std::size_t kColumns = 7;
constexpr const char* kKey = "waypoints.poses_s_m_rad";

struct Rows {
  std::vector<double> times_s;
  std::vector<Vector3d> positions_m;
  std::vector<Vector3d> angles_rad;
};

Rows SplitRows(const std::vector<double>& table) {
  Rows rows;
  for (std::size_t i = 0; i + kColumns <= table.size(); i += kColumns) {
    const double* row = table.data() + i;
    if (!rows.times_s.empty() && !(row[0] > rows.times_s.back())) {
      throw InputError("times must increase from row to row: row " + std::to_string(i / kColumns) +
                           " is at " + FormatNumber(row[0]) + " s, the row before at " +
                           FormatNumber(rows.times_s.back()) + " s",
                       kKey);
    }
    rows.times_s.push_back(row[0]);
    rows.positions_m.emplace_back(row[1], row[2], row[3]);
    rows.angles_rad.emplace_back(row[4], row[5], row[6]);
  }
  if (rows.times_s.size() < 2)
    throw InputError("give at least two rows of t, x, y, z, yaw, pitch, roll", kKey);
  if (rows.times_s[0] != 0) {
    throw InputError("the first row must be at 0 s, not at " + FormatNumber(rows.times_s[0]) + " s", kKey);
  }
  return rows;
}

WaypointScript MakeFromRows(const Rows& rows) {
  return WaypointScript(rows.times_s, rows.positions_m, rows.angles_rad);
}

}  // namespace

void WaypointParams::Visit(ParamVisitor& v) {
  v.Table({"poses_s_m_rad",
           "Rows of t [s], x, y, z [m], yaw, pitch, roll [rad]; equal neighbouring positions are a stop."},
          Range::Any(), kColumns, poses_s_m_rad);
}

WaypointScript::WaypointScript(const WaypointParams& params)
    : WaypointScript(MakeFromRows(SplitRows(params.poses_s_m_rad))) {}

WaypointScript::WaypointScript(const std::vector<double>& times_s, const std::vector<Vector3d>& positions_m,
                               const std::vector<Vector3d>& angles_rad)
    : duration_s_(times_s.back()), position_(times_s, positions_m), angles_(times_s, angles_rad) {
  std::set_union(position_.knots_s().begin(), position_.knots_s().end(), angles_.knots_s().begin(),
                 angles_.knots_s().end(), std::back_inserter(knots_s_));
}

ScriptPoint WaypointScript::Eval(double t_s) const {
  const SplinePoint p = position_.Eval(t_s);
  const SplinePoint a = angles_.Eval(t_s);
  return {{p.x, CalcAttitude(a.x)}, p.dx, p.ddx, CalcBodyRate(a.x, a.dx)};
}

}  // namespace piperun::sim
