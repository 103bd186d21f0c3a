#include "sim/bore_wall.h"

#include <algorithm>
#include <cmath>

namespace piperun::sim {
namespace {

constexpr double kOnAxis_m = 1e-9;      // closer, no wall is nearest
constexpr double kSameSheet = 0.7;      // cosine; farther turned, a foot belongs to another wall
constexpr double kContained_m = 1e-12;  // rounding of a depth

Pose MakeFrame(const Vector3d& origin_L, const Vector3d& x_L, const Vector3d& y_L) {
  Matrix3d R_LF;
  R_LF << x_L, y_L, x_L.cross(y_L);
  return {origin_L, Quaterniond(R_LF).normalized()};
}

/// The foot that goes on from one with this normal.
const WallFoot* FindContinued(const WallFeet& feet, const Vector3d& normal_F) {
  const WallFoot* best = nullptr;
  double best_cosine = kSameSheet;
  for (const WallFoot& foot : feet) {
    const double cosine = foot.normal.dot(normal_F);
    if (foot.kind != WallFoot::Kind::kSheet || cosine <= best_cosine) continue;
    best = &foot;
    best_cosine = cosine;
  }
  return best;
}

}  // namespace

void WallContacts::Add(const WallContact& contact) {
  if (size_ < kCapacity) {
    contacts_[size_++] = contact;
    return;
  }
  const auto narrower = [](const WallContact& a, const WallContact& b) { return a.gap_m < b.gap_m; };
  WallContact& widest = *std::max_element(contacts_.begin(), contacts_.end(), narrower);
  if (contact.gap_m < widest.gap_m) widest = contact;
}

BoreWall::BoreWall(const Bore& bore) : bore_(bore) {
  const Network& network = bore.network();
  for (std::size_t node = 0; node < network.nodes().size(); ++node) {
    const Joint& joint = bore.joint(static_cast<int>(node));
    const bool plain = joint.smooth || joint.arms.empty();
    joints_.push_back(plain ? nullptr : std::make_unique<const JointWall>(bore, joint));
  }
  for (std::size_t pipe = 0; pipe < network.pipes().size(); ++pipe) AddPipe(static_cast<int>(pipe));
}

void BoreWall::AddPipe(int pipe) {
  const Pipe& p = bore_.network().pipe(pipe);
  walls_.push_back(
      {pieces_.size(), p.radius_m(), BoreProfile(bore_, pipe), {MakeEnd(pipe, false), MakeEnd(pipe, true)}});
  for (const CentrelinePiece& line : p.centreline) pieces_.push_back(MakePiece(line));
}

BoreWall::End BoreWall::MakeEnd(int pipe, bool at_to) const {
  End end;
  const Pipe& p = bore_.network().pipe(pipe);
  if (!bore_.open(pipe)) return end;
  const int node = at_to ? p.to : p.from;
  const Joint& joint = bore_.joint(node);
  const JointArm& arm = bore_.FindArm(joint, {pipe, at_to});
  end.joint = joints_[static_cast<std::size_t>(node)].get();
  end.arm = static_cast<std::size_t>(&arm - joint.arms.data());
  end.reach_m = arm.reach_m;
  end.p_node_L = arm.p_end_L;
  end.plate_s_m = at_to ? p.length_m - CalcPlate_m(p, arm) : CalcPlate_m(p, arm);
  return end;
}

BoreWall::Piece BoreWall::MakePiece(const CentrelinePiece& line) {
  Piece p;
  if (line.straight()) {
    p.X_LF = MakeFrame(line.p_begin_W, line.tangent_begin_W, line.tangent_begin_W.unitOrthogonal());
  } else {
    p.bend_radius_m = 1 / line.curvature_1_m;
    const Vector3d centre_L = line.p_begin_W + p.bend_radius_m * line.normal_begin_W;
    p.X_LF = MakeFrame(centre_L, -line.normal_begin_W, line.tangent_begin_W);
  }
  p.X_FL = p.X_LF.Inverse();
  p.R_LF = p.X_LF.q.toRotationMatrix();
  return p;
}

const BoreWall::Piece& BoreWall::FindPiece(const NetworkSpot& spot) const {
  return pieces_[wall(spot).first_piece + spot.piece];
}

const BoreWall::End& BoreWall::NearEnd(const NetworkSpot& spot) const {
  return wall(spot).ends[spot.s_m > 0.5 * bore_.network().pipe(spot.pipe).length_m ? 1 : 0];
}

double BoreWall::CalcEndDistance_m(const NetworkSpot& spot) const {
  const double length_m = bore_.network().pipe(spot.pipe).length_m;
  return spot.s_m > 0.5 * length_m ? length_m - spot.s_m : spot.s_m;
}

bool BoreWall::IsPlain(const NetworkSpot& spot, double window_m) const {
  const End& end = NearEnd(spot);
  if (end.joint && CalcEndDistance_m(spot) < end.reach_m + window_m) return false;
  return bore_.network().pipe(spot.pipe).passable &&
         wall(spot).profile.IsUniform(spot.s_m - window_m, spot.s_m + window_m);
}

Vector3d BoreWall::CalcOffset(const Piece& piece, const Vector3d& p_F) {
  if (piece.bend_radius_m == 0) return {0, p_F.y(), p_F.z()};
  const double rho = std::sqrt(p_F.x() * p_F.x() + p_F.y() * p_F.y());
  const double outward = (rho - piece.bend_radius_m) / rho;
  return {outward * p_F.x(), outward * p_F.y(), p_F.z()};
}

/// Along the axis, from one point to another near by.
double BoreWall::CalcAdvance_m(const Piece& piece, const Vector3d& from_F, const Vector3d& to_F) {
  if (piece.bend_radius_m == 0) return to_F.x() - from_F.x();
  const double across = from_F.x() * to_F.y() - from_F.y() * to_F.x();
  const double along = from_F.x() * to_F.x() + from_F.y() * to_F.y();
  return piece.bend_radius_m * std::atan2(across, along);
}

PipePoint BoreWall::MakePipePoint(const NetworkSpot& spot, const Vector3d& p_F,
                                  const Vector3d& sideways_F) const {
  const Piece& piece = FindPiece(spot);
  PipePoint p;
  p.s_m = spot.s_m;
  p.tangent = piece.bend_radius_m == 0 ? Vector3d::UnitX() : Vector3d(-p_F.y(), p_F.x(), 0).normalized();
  const Vector3d offset = CalcOffset(piece, p_F);
  p.offset_m = offset.norm();
  if (p.offset_m >= kOnAxis_m) {
    p.out = offset / p.offset_m;
    return p;
  }
  const Vector3d across = sideways_F - sideways_F.dot(p.tangent) * p.tangent;
  p.out = across.norm() > 0 ? across.normalized() : p.tangent.unitOrthogonal();
  return p;
}

/// The plate between a pipe that is shut and its near end.
void BoreWall::AddPlate(const NetworkSpot& spot, const PipePoint& p, WallFeet& feet) const {
  const Pipe& pipe = bore_.network().pipe(spot.pipe);
  if (pipe.passable) return;
  const bool at_to = spot.s_m > 0.5 * pipe.length_m;
  const double free_m = at_to ? spot.s_m - NearEnd(spot).plate_s_m : NearEnd(spot).plate_s_m - spot.s_m;
  feet.Add({at_to ? p.tangent : Vector3d(-p.tangent), free_m, WallFoot::Kind::kPlane});
}

WallFeet BoreWall::FindFeet(const NetworkSpot& spot, const Vector3d& p_F, const Vector3d& sideways_F,
                            double limit_m) const {
  const PipePoint p = MakePipePoint(spot, p_F, sideways_F);
  const End& end = NearEnd(spot);
  if (end.joint && CalcEndDistance_m(spot) < end.reach_m + limit_m) {
    return FindFeetAtJoint(spot, p_F, p, limit_m, end);
  }
  WallFeet feet;
  wall(spot).profile.AddFeet(p, limit_m, kContactRange_m, feet);
  AddPlate(spot, p, feet);
  return feet;
}

WallFeet BoreWall::FindFeetAtJoint(const NetworkSpot& spot, const Vector3d& p_F, const PipePoint& p,
                                   double limit_m, const End& end) const {
  const Piece& piece = FindPiece(spot);
  const Matrix3d& R_LF = piece.R_LF;
  const Vector3d p_N = R_LF * p_F + (piece.X_LF.p - end.p_node_L);
  WallFeet own, joint, feet;
  wall(spot).profile.AddFeet(p, limit_m, kContactRange_m, own);
  bool contained = false;
  for (const WallFoot& foot : own) {
    contained = contained || foot.distance_m >= 0;
    if (foot.distance_m < 0 || end.joint->Covers(p_N - R_LF * (foot.distance_m * foot.normal), end.arm))
      continue;
    feet.Add(foot);
  }
  const JointWall::Depth depth = end.joint->FindDepth(p_N);
  if (!contained && depth.depth_m < -kContained_m) {
    WallFeet back;
    back.Add({R_LF.transpose() * depth.inward, depth.depth_m, WallFoot::Kind::kPlane});
    return back;
  }
  AddPlate(spot, p, feet);
  end.joint->AddFeet(p_N, end.arm, limit_m, kContactRange_m, joint);
  for (const WallFoot& foot : joint) {
    feet.Add({R_LF.transpose() * foot.normal, foot.distance_m, foot.kind, foot.feature});
  }
  return feet;
}

BoreWall::Landing BoreWall::Land(const NetworkSpot& spot, const Vector3d& p_F, const Vector3d& step_F,
                                 const Vector3d& normal_F) const {
  const Piece& piece = FindPiece(spot);
  const CentrelinePiece& line = bore_.network().pipe(spot.pipe).centreline[spot.piece];
  Landing to{spot, p_F + step_F, normal_F};
  // a bend's inner side is shorter than its axis: twice the step bounds the length covered (D < R_c)
  const double travel_m = 2 * step_F.norm();
  if (spot.s_m - travel_m >= line.s_begin_m && spot.s_m + travel_m <= line.s_end_m()) return to;
  const Vector3d p_L = piece.X_LF * to.p_F;
  const SpotMove move = FindNetworkSpot(bore_, p_L, spot);
  if (move.spot.pipe == spot.pipe && move.spot.piece == spot.piece) return to;
  const Pose& X_GL = X_FL(move.spot);
  const Vector3d shift_L = move.crossing ? move.crossing->shift_L : Vector3d::Zero();
  return {move.spot, X_GL * (p_L + shift_L), X_GL.q * (piece.X_LF.q * normal_F)};
}

double BoreWall::PredictDistance(const NetworkSpot& spot, const Vector3d& p_F, const WallFoot& foot,
                                 const Vector3d& step_F) const {
  if (foot.kind == WallFoot::Kind::kPlane) return foot.distance_m;  // the step is along it
  if (foot.kind == WallFoot::Kind::kPoint) return std::hypot(foot.distance_m, step_F.norm());
  Landing to = Land(spot, p_F, step_F, foot.normal);
  if (&FindPiece(to.spot) == &FindPiece(spot)) to.spot.s_m += CalcAdvance_m(FindPiece(spot), p_F, to.p_F);
  const WallFeet feet = FindFeet(to.spot, to.p_F, -to.normal_F, foot.distance_m + step_F.norm());
  const WallFoot* continued = FindContinued(feet, to.normal_F);
  return continued ? continued->distance_m : foot.distance_m;
}

/// Where one tube is all there is.
WallContacts BoreWall::ProbeTube(const NetworkSpot& spot, const Vector3d& p_F, const Vector3d& v_F,
                                 double radius_m, double dt_s) const {
  const Piece& piece = FindPiece(spot);
  WallContacts contacts;
  Vector3d offset = CalcOffset(piece, p_F);
  // from the axis, where no wall is nearest, the sphere is about to meet the one it moves to
  if (offset.norm() < kOnAxis_m) offset = CalcOffset(piece, p_F + dt_s * v_F);
  if (offset.norm() < kOnAxis_m) return contacts;
  const Vector3d normal_F = -offset.normalized();
  const double v_n = v_F.dot(normal_F);
  const Vector3d step_F = (v_F - v_n * normal_F) * dt_s;
  const Landing to = Land(spot, p_F, step_F, normal_F);
  const double gap_m = wall(to.spot).radius_m - radius_m - CalcOffset(FindPiece(to.spot), to.p_F).norm();
  const double present_gap_m = wall(spot).radius_m - radius_m - offset.norm();
  if (gap_m + v_n * dt_s < kContactRange_m) contacts.Add({normal_F, gap_m, -1, present_gap_m});
  contacts.rescue = offset.norm() > wall(spot).radius_m;
  return contacts;
}

WallContacts BoreWall::Probe(const NetworkSpot& spot, const Vector3d& p_F, const Vector3d& v_F,
                             double radius_m, double dt_s) const {
  const double window_m = radius_m + kContactRange_m + 2 * dt_s * v_F.norm();
  if (IsPlain(spot, window_m)) return ProbeTube(spot, p_F, v_F, radius_m, dt_s);
  WallContacts contacts;
  for (const WallFoot& foot : FindFeet(spot, p_F, v_F, window_m)) {
    contacts.rescue = contacts.rescue || foot.distance_m < 0;
    if (foot.distance_m > window_m) continue;
    const double v_n = v_F.dot(foot.normal);
    const Vector3d step_F = (v_F - v_n * foot.normal) * dt_s;
    const double gap_m = PredictDistance(spot, p_F, foot, step_F) - radius_m;
    if (gap_m + v_n * dt_s < kContactRange_m) {
      contacts.Add({foot.normal, gap_m, foot.feature, foot.distance_m - radius_m});
    }
  }
  return contacts;
}

}  // namespace piperun::sim
