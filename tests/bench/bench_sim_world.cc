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
void RollAlong(benchmark::State& state, const std::vector<Vector3d>& points, const TubeBall& ball = kBall) {
  const testing::BoreNetwork line = testing::MakeBoreLine(points);
  BallWorld world(line.bore, ball, Rate(1000), At(line.network, 0, {0.01, 0, -kRun_m}, {0.8, 0, 0}),
                  [](const BallInstant& ball) {
                    const Vector3d u = 0.8 * ball.spot.axis.tangent_W - ball.v_WB_W;
                    return BallLoad{0.5 * u - Vector3d(0, 0, kWeight_N), Vector3d::Zero()};
                  });
  for (auto _ : state) world.Step();
  benchmark::DoNotOptimize(world.state().X_LB.p.x());
  state.SetItemsProcessed(state.iterations());
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

std::vector<Vector3d> ZigZag() {
  std::vector<Vector3d> points{Vector3d::Zero()};
  for (int i = 0; i < 2000; ++i)
    points.push_back(points.back() + (i % 2 ? Vector3d(0, 1, 0) : Vector3d(1, 0, 0)));
  return points;
}

/// Attitude acts on the motion of this one.
TubeBall EccentricBall() {
  TubeBall ball = kBall;
  ball.inertia_B_kg_m2 = Matrix3d(Vector3d(5e-5, 4e-5, 6e-5).asDiagonal());
  ball.p_BM_B = {0, 0, -1e-3};
  ball.spinning_length_m = 3e-4;
  return ball;
}

BENCHMARK_CAPTURE(RollAlong, straight, std::vector<Vector3d>{{0, 0, 0}, {100000, 0, 0}});
BENCHMARK_CAPTURE(RollAlong, bends, ZigZag());
BENCHMARK_CAPTURE(RollAlong, eccentric, std::vector<Vector3d>{{0, 0, 0}, {100000, 0, 0}}, EccentricBall());
BENCHMARK_CAPTURE(RollInTee, side_branch, Vector3d(0, 1, 0));
BENCHMARK_CAPTURE(RollInTee, branch_down, Vector3d(0, 0, -1));

}  // namespace
}  // namespace piperun::sim
