#include <benchmark/benchmark.h>

#include <cmath>

#include "sim/ball_world.h"
#include "tests/support/pipes.h"

namespace piperun::sim {
namespace {

const TubeBall kBall{0.03, 0.181, 4.5e-5, 0.5, 3e-4};
constexpr double kWeight_N = 0.11, kRun_m = 0.045;

BallStart At(const Network& network, int pipe, const Vector3d& p_L, const Vector3d& v_L) {
  return {{p_L, Quaterniond::Identity()}, v_L, Vector3d::Zero(), testing::FindSpot(network, pipe, p_L)};
}

/// One step of the ball alone, dragged along by 0.8 m/s without the water's profile.
void Roll(benchmark::State& state, const testing::BoreNetwork& line) {
  BallWorld world(line.bore, kBall, Rate(1000), At(line.network, 0, {0.01, 0, -kRun_m}, {0.8, 0, 0}),
                  [](const BallInstant& ball) {
                    const Vector3d u = 0.8 * ball.spot.axis.tangent_W - ball.v_WB_W;
                    return BallLoad{0.5 * u - Vector3d(0, 0, kWeight_N), Vector3d::Zero()};
                  });
  for (auto _ : state) world.Step();
  benchmark::DoNotOptimize(world.state().X_LB.p.x());
  state.SetItemsProcessed(state.iterations());
}

void RollAlong(benchmark::State& state, const std::vector<Vector3d>& points) {
  Roll(state, testing::MakeBoreLine(points));
}

/// The same in the mouths of a tee with a branch of its own bore, to and fro, so that it never leaves them.
void RollInTee(benchmark::State& state, const Vector3d& branch) {
  const testing::BoreNetwork tee(
      testing::MakeStar(Vector3d::Zero(), {{{3, 0, 0}, 0.075}, {{-3, 0, 0}, 0.075}, {3 * branch, 0.06}}));
  BallWorld world(tee.bore, kBall, Rate(1000), At(tee.network, 0, {0.01, 0, -kRun_m}, {0.5, 0, 0}),
                  [&](const BallInstant& ball) {
                    const double t = Seconds(ball.time.time_since_epoch());
                    const Vector3d pull(2 * std::cos(9 * t), 0.5 * std::cos(4 * t), -kWeight_N);
                    return BallLoad{pull - 4 * ball.p_LB - 0.2 * ball.v_WB_W, Vector3d::Zero()};
                  });
  for (auto _ : state) world.Step();
  benchmark::DoNotOptimize(world.state().X_LB.p.x());
  state.SetItemsProcessed(state.iterations());
}

/// A joint with a gap of 5 mm and an offset of 1 mm that leads back over 0.3 m.
WallFeature MakeJoint(double s_m) {
  const double radius_m = 0.075, edge_m = 0.001, rim_m = 0.0025 + edge_m;
  const Vector3d down = -Vector3d::UnitZ();
  return {0,
          s_m,
          {{s_m, down, GrooveFloor{0.0025, edge_m, 0.008}},
           {s_m - rim_m, down, GrooveRim{radius_m, edge_m, 1}},
           {s_m + rim_m, down, GrooveRim{radius_m, edge_m, -1}},
           {s_m + rim_m, down, OffsetSleeve{radius_m, edge_m, 0.001, 0.3}}}};
}

/// The same on a straight with a joint every 6 m, most steps clear of any.
void RollOverJoints(benchmark::State& state) {
  testing::BoreNetwork line = testing::MakeBoreLine({{0, 0, 0}, {100000, 0, 0}});
  std::vector<WallFeature> joints;
  for (int i = 1; i < 16000; ++i) joints.push_back(MakeJoint(6.0 * i));
  line.bore.SetFeatures(std::move(joints));
  Roll(state, line);
}

std::vector<Vector3d> ZigZag() {
  std::vector<Vector3d> points{Vector3d::Zero()};
  for (int i = 0; i < 2000; ++i)
    points.push_back(points.back() + (i % 2 ? Vector3d(0, 1, 0) : Vector3d(1, 0, 0)));
  return points;
}

BENCHMARK_CAPTURE(RollAlong, straight, std::vector<Vector3d>{{0, 0, 0}, {100000, 0, 0}});
BENCHMARK(RollOverJoints);
BENCHMARK_CAPTURE(RollAlong, bends, ZigZag());
BENCHMARK_CAPTURE(RollInTee, side_branch, Vector3d(0, 1, 0));
BENCHMARK_CAPTURE(RollInTee, branch_down, Vector3d(0, 0, -1));

}  // namespace
}  // namespace piperun::sim
