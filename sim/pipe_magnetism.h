#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "base/network.h"
#include "base/params.h"

namespace piperun::sim {

/// Where two sticks of a pipe meet.
struct StickJoint {
  int pipe = 0;
  double s_m = 0;
};

/// What pipes of iron and steel do to the magnetic field inside them.
struct PipeMagnetismParams {
  bool shield = false;
  double joint_amplitude_T = 0;           ///< A
  double joint_amplitude_sd_T = 0;        ///< from joint to joint
  double joint_width_m = 0.1;             ///< sigma
  std::optional<double> joint_spacing_m;  ///< nothing: where wall features of kind joint stand

  void Visit(ParamVisitor& v);
  bool has_joints() const { return joint_amplitude_T != 0 || joint_amplitude_sd_T > 0; }
  bool any() const { return shield || has_joints(); }
};

/// Transverse field inside over the one outside of an infinitely long tube of inner radius a, outer radius b
/// and relative permeability mu,
///
///   S = 4 mu / ((mu + 1)^2 - (mu - 1)^2 (a/b)^2),
///
/// the solution of Laplace's equation with continuous normal B and tangential H at both walls. Linear: for
/// weak fields, far from saturation. 0 < a < b, mu >= 1.
double CalcTransverseShielding(double mu, double inner_radius_m, double outer_radius_m);

/// The field in a tube along the unit vector `axis`: its transverse part times S, its axial part as it is (H
/// along a wall is continuous, so a tube without ends does not shield its axis). Axes and unit are the
/// field's.
Vector3d CalcFieldInTube(const Vector3d& field, const Vector3d& axis, double shielding);

/// The field at the axis of a network's pipes, with t the axis and B_0 the field of the earth,
///
///   B(s) = t (t . B_0) + S (B_0 - t (t . B_0)) + sum_j A_j e_j exp(-(s - s_j)^2 / (2 sigma^2)).
///
/// S: CalcTransverseShielding. At joint j, A_j = A + sd N(0, 1), and e_j is even on the sphere and fixed in
/// W: sticks are magnetised as they were made, lifted and laid. Both are drawn by seed, pipe, joint and run,
/// so that all sensors feel the same pipe. Pipes with mu_r = 1 do nothing.
///
/// For points a diameter and more from a pipe's end; there the field changes in a step, where a real one goes
/// over as exp(-3.8 z / a) (transverse) and more slowly along the axis. Left out: fields across the bore that
/// differ from its axis's, remanence of whole sticks, welds, currents of cathodic protection, hysteresis.
class PipeMagnetism {
 public:
  struct Site {
    const Network* network = nullptr;      ///< read now, not kept
    std::span<const StickJoint> joints{};  ///< as described; likewise
    std::uint64_t seed = 0;
    std::uint64_t run = 0;
  };
  /// Throws InputError (shield, joint_amplitude_T, joint_spacing_m) for effects of pipes without pipes, and
  /// for anomalies of joints where no joint stands in a magnetic pipe.
  PipeMagnetism(const PipeMagnetismParams& params, const Site& site);

  /// Flux density in W, where the axis of pipe `pipe` (-1: none) has the tangent `axis_W` at s.
  Vector3d CalcField_W_T(const Vector3d& earth_W_T, int pipe, double s_m, const Vector3d& axis_W) const;
  bool any() const { return !tubes_.empty(); }

 private:
  struct Anomaly {
    double s_m = 0;
    Vector3d b_W_T = Vector3d::Zero();  ///< A_j e_j
  };
  struct Tube {
    double shielding = 1;
    std::vector<Anomaly> anomalies;  ///< by s
  };
  static Tube MakeTube(const PipeMagnetismParams& params, const Site& site, int pipe);
  Vector3d SumAnomalies_W_T(const Tube& tube, double s_m) const;

  double width_m_;
  std::vector<Tube> tubes_;  ///< per pipe; none: nothing to do
};

}  // namespace piperun::sim
