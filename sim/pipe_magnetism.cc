#include "sim/pipe_magnetism.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "base/random.h"

namespace piperun::sim {
namespace {

constexpr double kReach = 6;  // widths; beyond, less than 2e-8 of an anomaly is left

/// Where the joints of a pipe stand, by s.
std::vector<double> FindJoints_m(const PipeMagnetismParams& params, const PipeMagnetism::Site& site,
                                 int pipe) {
  std::vector<double> places_m;
  if (params.joint_spacing_m) {
    const double length_m = site.network->pipe(pipe).length_m, spacing_m = *params.joint_spacing_m;
    for (int k = 1; k * spacing_m < length_m; ++k) places_m.push_back(k * spacing_m);
    return places_m;
  }
  for (const StickJoint& joint : site.joints) {
    if (joint.pipe == pipe) places_m.push_back(joint.s_m);
  }
  std::sort(places_m.begin(), places_m.end());
  return places_m;
}

/// A_j e_j of joint `number` of a pipe.
Vector3d DrawAnomaly_W_T(const PipeMagnetismParams& params, const RandomStream& random, std::size_t number) {
  const auto n = random.Normals(number, 0);
  const double amplitude_T = params.joint_amplitude_T + params.joint_amplitude_sd_T * n[3];
  return amplitude_T * Vector3d(n[0], n[1], n[2]).normalized();
}

void RequirePipes(const PipeMagnetismParams& params, const PipeMagnetism::Site& site) {
  if (site.network || !params.any()) return;
  throw InputError("a pipe's magnetism needs a pipe, and this scenario has no network",
                   params.shield ? "shield" : "joint_amplitude_T");
}

}  // namespace

void PipeMagnetismParams::Visit(ParamVisitor& v) {
  v.Flag({"shield", "Walls of iron and steel keep the transverse field out, by their permeability."}, shield);
  v.Number({"joint_amplitude_T", "Anomaly at every joint of sticks of a magnetic pipe, on the axis."},
           Range::Between(-1, 1), joint_amplitude_T);
  v.Number({"joint_amplitude_sd_T", "Its scatter from joint to joint; the direction is always drawn."},
           Range::Between(0, 1), joint_amplitude_sd_T);
  v.Number({"joint_width_m", "Standard width of the anomaly's bell along the axis; default: assumed."},
           Range::Between(0.001, 10), joint_width_m);
  v.NumberOr({"joint_spacing_m",
              "Joints of every magnetic pipe, this far apart from its `from` end on; or those that stand as "
              "wall features of kind joint."},
             Range::Between(0.1, 1000), "wall_features", joint_spacing_m);
}

double CalcTransverseShielding(double mu, double inner_radius_m, double outer_radius_m) {
  const double ratio = inner_radius_m / outer_radius_m;
  return 4 * mu / ((mu + 1) * (mu + 1) - (mu - 1) * (mu - 1) * ratio * ratio);
}

Vector3d CalcFieldInTube(const Vector3d& field, const Vector3d& axis, double shielding) {
  return shielding * field + (1 - shielding) * axis.dot(field) * axis;
}

PipeMagnetism::PipeMagnetism(const PipeMagnetismParams& params, const Site& site)
    : width_m_(params.joint_width_m) {
  RequirePipes(params, site);
  if (!params.any()) return;
  const auto pipes = static_cast<int>(site.network->pipes().size());
  for (int pipe = 0; pipe < pipes; ++pipe) tubes_.push_back(MakeTube(params, site, pipe));
  const auto has_anomalies = [](const Tube& tube) { return !tube.anomalies.empty(); };
  if (params.has_joints() && std::none_of(tubes_.begin(), tubes_.end(), has_anomalies)) {
    throw InputError(
        "no joint stands in a pipe of iron or steel; give joint_spacing_m (below the pipes' length) or wall "
        "features of kind joint, or leave the amplitude at 0",
        "joint_spacing_m");
  }
}

PipeMagnetism::Tube PipeMagnetism::MakeTube(const PipeMagnetismParams& params, const Site& site, int i) {
  const Pipe& pipe = site.network->pipe(i);
  const double mu = pipe.material.relative_permeability, radius_m = pipe.radius_m();
  Tube tube;
  if (!(mu > 1)) return tube;
  if (params.shield) {
    tube.shielding = CalcTransverseShielding(mu, radius_m, radius_m + pipe.wall_thickness_m);
  }
  if (!params.has_joints()) return tube;
  const RandomStream random(site.seed, "pipe_magnetism." + pipe.id, site.run);
  for (const double s_m : FindJoints_m(params, site, i)) {
    tube.anomalies.push_back({s_m, DrawAnomaly_W_T(params, random, tube.anomalies.size())});
  }
  return tube;
}

Vector3d PipeMagnetism::SumAnomalies_W_T(const Tube& tube, double s_m) const {
  Vector3d sum_W_T = Vector3d::Zero();
  const double reach_m = kReach * width_m_;
  const auto before = [](const Anomaly& a, double s) { return a.s_m < s; };
  auto anomaly = std::lower_bound(tube.anomalies.begin(), tube.anomalies.end(), s_m - reach_m, before);
  for (; anomaly != tube.anomalies.end() && anomaly->s_m <= s_m + reach_m; ++anomaly) {
    const double x = (s_m - anomaly->s_m) / width_m_;
    sum_W_T += std::exp(-0.5 * x * x) * anomaly->b_W_T;
  }
  return sum_W_T;
}

Vector3d PipeMagnetism::CalcField_W_T(const Vector3d& earth_W_T, int pipe, double s_m,
                                      const Vector3d& axis_W) const {
  if (pipe < 0 || tubes_.empty()) return earth_W_T;
  const Tube& tube = tubes_[static_cast<std::size_t>(pipe)];
  return CalcFieldInTube(earth_W_T, axis_W, tube.shielding) + SumAnomalies_W_T(tube, s_m);
}

}  // namespace piperun::sim
