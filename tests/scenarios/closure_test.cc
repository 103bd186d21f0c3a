// The thirty-line integrator that knows nothing of piperun: it reads the run folder of the scenario
// `closure`.

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "tests/scenarios/small_scenario.h"

namespace piperun::scenarios {
namespace {

std::vector<std::vector<double>> ReadNumbers(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::vector<std::vector<double>> rows;
  std::string line;
  while (std::getline(file, line)) {
    if (line.empty() || line[0] == '#') continue;
    std::stringstream fields(line);
    rows.emplace_back();
    for (std::string field; std::getline(fields, field, ',');)
      rows.back().push_back(std::strtod(field.c_str(), nullptr));
  }
  return rows;
}

TEST(Closure, IntegratedIncrementsReturnTheTrack) {
  const TemporaryFolder folder;
  const RunResult result = RunInto(LoadScenario("closure"), folder / "run");
  ASSERT_EQ(result.status, "ok");
  ASSERT_GE(result.route_length_m, 90);
  const auto truth = ReadNumbers(folder / "run/truth/ball.csv");
  const auto imu = ReadNumbers(folder / "run/mav0/imu0/increments.csv");

  const double dt = 1e-3;
  const Eigen::Vector3d g(0, 0, -9.80665);
  const std::vector<double>& start = truth[0];
  Eigen::Vector3d p(start[4], start[5], start[6]);
  Eigen::Matrix3d R = Eigen::Quaterniond(start[7], start[8], start[9], start[10]).toRotationMatrix();
  Eigen::Vector3d v(start[11], start[12], start[13]);
  for (const auto& row : imu) {
    const Eigen::Vector3d dtheta(row[1], row[2], row[3]), dv(row[4], row[5], row[6]);
    v += R * dv + g * dt;
    p += v * dt;
    if (dtheta.norm() > 0) R = R * Eigen::AngleAxisd(dtheta.norm(), dtheta.normalized()).toRotationMatrix();
  }
  const auto end =
      std::find_if(truth.begin(), truth.end(), [&](const auto& row) { return row[0] == imu.back()[0]; });
  ASSERT_NE(end, truth.end());
  const std::vector<double>& e = *end;
  const double error_m = (p - Eigen::Vector3d(e[4], e[5], e[6])).norm();
  const Eigen::Matrix3d R_true = Eigen::Quaterniond(e[7], e[8], e[9], e[10]).toRotationMatrix();
  const double angle_rad = Eigen::AngleAxisd(R.transpose() * R_true).angle();
  std::printf("strapdown closure: %.3g m, %.3g rad over %.2f m\n", error_m, angle_rad, e[3]);
  EXPECT_LE(error_m, 1e-6);
  EXPECT_LE(angle_rad, 1e-7);
  EXPECT_GE(e[3], 90);
}

}  // namespace
}  // namespace piperun::scenarios
