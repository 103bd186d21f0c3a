#pragma once

#include <map>
#include <memory>
#include <vector>

#include "base/water.h"
#include "sim/axial_flow.h"
#include "sim/cross_flow.h"
#include "sim/flow_timeline.h"
#include "sim/force_params.h"
#include "sim/junction_flow.h"
#include "sim/network_spot.h"
#include "sim/pipe_flow.h"
#include "sim/secondary_flow.h"
#include "sim/swirl.h"

namespace piperun::sim {

/// A ball closer than this to a wall touches it: far above rounding, far below anything it would feel.
inline constexpr double kTouching_m = 1e-6;

/// Mean (not turbulent) flow as a ball sees it: averages over its frontal disc, in W.
struct WaterAtBall {
  Vector3d velocity_W = Vector3d::Zero();
  Vector3d acceleration_W = Vector3d::Zero();        ///< Du/Dt = du/dt + u . grad u
  Vector3d spin_W = Vector3d::Zero();                ///< 1/2 curl u
  Vector3d pressure_fall_W_Pa_m = Vector3d::Zero();  ///< -grad p that friction costs, along the flow
  double bulk_speed_m_s = 0;                         ///< Q/A, positive from `from` to `to` of the pipe
  double pressure_Pa = 0;                            ///< gauge, static, at the ball's centre
  double bore_radius_m = 0;                          ///< of the bore around the ball
  double friction_velocity_m_s = 0;                  ///< u* = |U| sqrt(f/8)
  Vector3d axis_W = Vector3d::UnitX();               ///< tangent of the pipe's axis, unit
  Vector3d from_wall_W = Vector3d::Zero();  ///< unit, from the nearest wall to the ball; zero on the axis
  double wall_gap_m = 0;                    ///< between the ball and that wall
};

/// The flow in a network around a ball of one size. Along pipes:
///
///   u      = U uhat(offset) k t,      k = 1/(1 - d . kappa)   (d: from the axis to the ball's centre)
///   Du/Dt  = |u|^2 k kappa + dU/dt uhat k t      centripetal, towards the bend's centre
///   curl u = grad u x t,              grad u the mean gradient over the disc
///   -dp/ds = f/D rho U^2/2            friction (Darcy-Weisbach)
///   p      = rho g (head - z)
///
/// uhat: profile of sim/pipe_flow.h. k makes the flow in a bend a free vortex (u ~ 1/r about the bend's
/// axis); it is 1 on a straight, and keeps the flow rate within (R/R_c)^2/4. Curvature and k begin at once
/// with the bend, where a real flow takes about a diameter.
///
/// Fittings, divergence-free by construction (docs/physics.md, "Flow in fittings"):
/// - Cones and places that take water out (leaks, nodes of two pipes): a Stokes stream function
///   (sim/axial_flow.h), with the profile's own mean over the ball's disc; the water taken leaves through the
///   wall along one diameter to either side.
/// - Joints: potential flow (sim/junction_flow.h) up to 2.5 radii past the last opening, where it is uniform;
///   from there the uniform flow goes over into the pipe's profile along four radii. A harmonic velocity's
///   mean over a ball is its value at the centre, so there is nothing to average. Pipes too short for that
///   are shared by their joints half and half. Nodes with one pipe, and joints with nearly parallel arms
///   (JunctionFlow::Covers), have no joint flow: the pipe's flow goes up to the node.
///
/// In bends and behind them a flow across the pipe comes on top (sim/secondary_flow.h); Du/Dt and curl are
/// those of the sum. Not in joints, which potential flow passes without; towards them it fades with the
/// profile.
///
/// Left out: separation, turbulence (sim/turbulence.h adds it), velocity heads (as by the hydraulics).
class FlowField {
 public:
  /// References are kept. Where flow passes the ball must fit: d/D <= 0.95 (aborts on a spot in a bore
  /// that is tighter).
  FlowField(const Bore& bore, const FlowTimeline& flow, const WaterProperties& water, double gravity_m_s2,
            double ball_radius_m, const StreamParams& stream = {});

  /// Flow at `spot` for a ball centred at p_L, in the drawing of the spot's pipe. `swirl` turns the single
  /// cell behind bends; by default there is none. Bores and joints are worked
  /// out when they are met first (1 ms and 20 to 400 ms); nothing else allocates. Not for several threads.
  WaterAtBall Eval(const NetworkSpot& spot, const Vector3d& p_L, TrueTime t, const Swirl& swirl = {}) const;

  /// The flow of the joint at a node, or null where there is none; for reports.
  const JunctionFlow* FindJunction(int node) const;

 private:
  /// What an end of a pipe does to the flow.
  struct EndZone {
    double reach_m = 0;    ///< other arms are felt so far
    double core_m = 0;     ///< the joint's flow reaches so far; 0: none
    double profile_m = 0;  ///< the pipe's profile stands from here on
  };
  struct PipeZones {
    EndZone from, to;
    double profile_share = 1;  ///< of the profile between the ends; less in short pipes
  };
  /// Part of a reach in which nothing but the pipe's own developed flow is felt; may be empty.
  struct Span {
    double begin_m = 0;
    double end_m = 0;
    bool Contains(double s_m) const { return s_m >= begin_m && s_m <= end_m; }
  };
  struct PipeTables {
    const DiscMeanTable* body = nullptr;
    const DiscMeanTable* from = nullptr;  ///< at a cone's wide end
    const DiscMeanTable* to = nullptr;
  };
  struct Junction {
    JunctionFlow flow;
    std::vector<double> outflow_m3_s;          // scratch: per arm
    std::vector<double> outflow_change_m3_s2;  // their time derivatives
  };
  struct Site;  // a spot with what the flow there depends on

  PipeZones MakeZones(int pipe) const;
  Span CalcFlowSpan(int pipe, const FlowReach& reach) const;
  Span CalcDevelopedSpan(int pipe, const FlowReach& reach) const;
  bool HasJunction(const Joint& joint) const;
  Site MakeSite(const NetworkSpot& spot, const Vector3d& p_L, TrueTime t, const Swirl& swirl) const;
  Jet CalcFlow(const Site& site) const;
  double FlowBeyond(const Site& site, bool at_to) const;
  Jet CalcProfileShare(const Site& site) const;
  AxialFlow CalcAxialFlow(const Site& site, const Jet& flow, const Jet& share) const;

  WaterAtBall EvalMean(const Site& site) const;
  WaterAtBall EvalDeveloped(const Site& site) const;
  WaterAtBall EvalShaped(const Site& site, const Jet& flow, const Jet& share) const;
  WaterAtBall EvalJunction(const Site& site, bool at_to) const;
  void SetOutflows(const Joint& joint, TrueTime t, Junction& junction) const;
  void FillJunctionScalars(const Site& site, bool at_to, double outflow_m3_s, WaterAtBall& water) const;
  /// Adds the flow across the pipe to the flow along it.
  void AddCrossFlow(const Site& site, const Jet& flow, const Jet& share, const AxialFlow& main,
                    WaterAtBall& water) const;
  CrossSpeed CalcCrossSpeed(const Site& site, const Jet& bulk) const;
  void FillSurroundings(const Site& site, WaterAtBall& water) const;
  void AddFriction(const Site& site, double share, WaterAtBall& water) const;

  Junction& FindOrMakeJunction(int node) const;
  /// Of a bore; of the narrowest that the ball fits into, where it is narrower: a cone leads there.
  const DiscMeanTable& FindOrMakeTable(double radius_m) const;
  const PipeTables& Tables(int pipe) const;

  const Bore& bore_;
  const FlowTimeline& flow_;
  WaterProperties water_;
  double gravity_m_s2_;
  double ball_radius_m_;
  bool cross_flow_;
  SecondaryFlow secondary_;
  ProfileLaw profile_;
  std::vector<PipeZones> zones_;                                     // per pipe
  std::vector<std::vector<Span>> developed_;                         // per pipe and reach
  mutable std::map<double, std::unique_ptr<DiscMeanTable>> tables_;  // by bore radius
  mutable std::vector<PipeTables> pipe_tables_;                      // per pipe
  mutable std::vector<std::unique_ptr<Junction>> junctions_;         // per node
};

}  // namespace piperun::sim
