#pragma once

#include <optional>
#include <vector>

#include "sim/network/hydraulic_state.h"
#include "sim/network/model.h"

namespace piperun::sim {

/// Water slower than this stands still for anybody who waits for it.
inline constexpr double kLeastSpeed_m_s = 1e-3;

/// What keeps a ball from passing a link.
enum class Obstacle { kNone, kTooNarrow, kClosed, kPump, kCheckValve, kControlValve };
/// "passes", "too narrow", "closed", "pump", "check valve", "control valve".
const char* ObstacleText(Obstacle obstacle);

/// Whether a valve leaves its whole bore open: it is fixed open, a TCV throttles no more than its own minor
/// loss, or a PCV stands at 100 %.
bool IsWideOpen(ValveKind kind, LinkStatus status, double setting, double minor_loss);

/// What is in a ball's way in a link: nothing in an open pipe, or a valve wide open, of which it fills at
/// most kMaxDiameterRatio. The impeller of a pump, the flap of a check valve and the seat of a control
/// valve stop it whether water flows or not.
Obstacle FindObstacle(const HydraulicModel& model, const HydraulicState& state, int link,
                      double ball_diameter_m);

/// Bore of a pipe or valve [m]; 0: a pump has none.
double Bore_m(const HydraulicModel& model, int link);

/// Bulk speed |Q|/A of a pipe or valve [m/s]; 0 in a pump, which has no bore, and in what is closed.
double CalcSpeed_m_s(const HydraulicModel& model, const HydraulicState& state, int link);

/// A node that water comes by, and how: through `link`, so much time and way after the start.
struct WayPoint {
  int node = 0;
  int link = -1;  ///< -1: the start
  double time_s = 0;
  double distance_m = 0;
};

/// Where a way along the greatest flow ends, and what lies ahead there.
enum class WayEnd {
  kArrived,        ///< at the node asked for
  kLeavesNetwork,  ///< in a reservoir or tank
  kDeadEnd,        ///< no water flows on: customers take all of it
  kBlocked,        ///< water flows on through links that the ball cannot pass
};

struct WaterWay {
  std::vector<WayPoint> points;  ///< the start first
  WayEnd end = WayEnd::kDeadEnd;
};

/// The ways water takes from a node in one state of a network, at its bulk speed, along its flow; pipes in
/// which it moves slower than kLeastSpeed_m_s or that a ball cannot pass end a way, reservoirs and tanks too.
/// Valves have no length. Diameter 0: the water itself.
class WaterWays {
 public:
  WaterWays(const HydraulicModel& model, const HydraulicState& state, double ball_diameter_m);

  /// The fastest way to every node that can be reached from `from`, by time (Dijkstra 1959).
  std::vector<WayPoint> FindReachable(int from) const;
  /// The fastest way from `from` to `to`; nothing when there is none.
  std::optional<WaterWay> FindFastest(int from, int to) const;
  /// The way that leaves every node through the passable link that takes most of the water.
  WaterWay FollowMainFlow(int from, std::optional<int> to = std::nullopt) const;

 private:
  struct Stretch {
    int link;
    int node;  ///< where it leads
    double flow_m3_s;
    double time_s;
    double length_m;
  };
  void AddStretch(int link);
  bool IsEnd(int node) const { return node >= model_.junction_count(); }

  const HydraulicModel& model_;
  const HydraulicState& state_;
  double ball_diameter_m_;
  std::vector<std::vector<Stretch>> onward_;  // per node
  std::vector<bool> blocked_;                 // per node: water flows on where the ball cannot
};

}  // namespace piperun::sim
