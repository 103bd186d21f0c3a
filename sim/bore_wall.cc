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

/// The foot that goes on from one with this normal on this body.
const WallFoot* FindContinued(const WallFeet& feet, const Vector3d& normal_F, int body) {
  const WallFoot* best = nullptr;
  double best_cosine = kSameSheet;
  for (const WallFoot& foot : feet) {
    const double cosine = foot.normal.dot(normal_F);
    if (foot.kind != WallFoot::Kind::kSheet || foot.body != body || cosine <= best_cosine) continue;
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
  PlaceFeatures();
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

void BoreWall::PlaceFeatures() {
  const auto& features = bore_.features();
  int body = 0;
  for (std::size_t i = 0; i < features.size(); ++i) {
    for (const FeatureShape& shape : features[i].shapes) {
      PlacedShape placed;
      placed.feature = static_cast<int>(i);
      placed.body = body++;
      placed.shape = &shape.body;
      const ShapePlace place = MakePlace(features[i].pipe, shape);
      PlaceInPipe(place, placed);
      for (const bool at_to : {false, true}) PlaceBeyond(place, at_to, placed);
    }
  }
  if (body == 0) return;
  for (std::size_t pipe = 0; pipe < walls_.size(); ++pipe) {
    const std::size_t end = pipe + 1 < walls_.size() ? walls_[pipe + 1].first_piece : pieces_.size();
    for (std::size_t i = walls_[pipe].first_piece; i < end; ++i) {
      pieces_[i].features.Finish(2 * walls_[pipe].radius_m);
    }
  }
}

BoreWall::ShapePlace BoreWall::MakePlace(int pipe, const FeatureShape& shape) const {
  const CentrelinePoint axis = bore_.network().pipe(pipe).Eval(shape.s_m);
  const Vector3d& x_L = axis.tangent_W;
  const Vector3d y_L = (shape.towards_W - shape.towards_W.dot(x_L) * x_L).normalized();
  ShapePlace place;
  place.pipe = pipe;
  place.s_m = shape.s_m;
  place.extent = CalcExtent(shape.body);
  place.p_LG = axis.p_W;
  place.R_LG << x_L, y_L, x_L.cross(y_L);
  return place;
}

/// Into every piece in which a ball may touch it: one diameter of room, and in a bend, whose inner side is
/// shorter than its axis, as much more.
void BoreWall::PlaceInPipe(const ShapePlace& place, PlacedShape shape) {
  const Pipe& pipe = bore_.network().pipe(place.pipe);
  const double a = place.sense * place.extent.begin_m, b = place.sense * place.extent.end_m;
  for (std::size_t i = 0; i < pipe.centreline.size(); ++i) {
    const CentrelinePiece& line = pipe.centreline[i];
    const double stretch = 1 / (1 - pipe.radius_m() * line.curvature_1_m);
    const double more_m = (stretch - 1) * (b > a ? b - a : a - b) + (stretch - 1) * pipe.diameter_m;
    shape.s_m = place.s_m;
    shape.begin_m = place.s_m + std::min(a, b) - more_m;
    shape.end_m = place.s_m + std::max(a, b) + more_m;
    const double room_m = stretch * pipe.diameter_m;
    if (shape.begin_m - room_m > line.s_end_m() || shape.end_m + room_m < line.s_begin_m) continue;
    Piece& piece = pieces_[walls_[static_cast<std::size_t>(place.pipe)].first_piece + i];
    shape.p_FG = piece.X_FL * place.p_LG;
    shape.R_GF = place.R_LG.transpose() * piece.R_LF;
    piece.features.Add(shape);
  }
}

/// And into the pipe behind a smooth joint, when it is felt there.
void BoreWall::PlaceBeyond(const ShapePlace& place, bool at_to, const PlacedShape& shape) {
  const Pipe& pipe = bore_.network().pipe(place.pipe);
  const double a = place.s_m + place.sense * place.extent.begin_m;
  const double b = place.s_m + place.sense * place.extent.end_m;
  const double from_end_m = at_to ? pipe.length_m - std::max(a, b) : std::min(a, b);
  const Joint& joint = bore_.joint(at_to ? pipe.to : pipe.from);
  if (from_end_m > 2 * pipe.diameter_m || !joint.smooth) return;
  const PipeEnd here{place.pipe, at_to};
  const PipeEnd there = joint.arms[joint.arms[0].end == here ? 1 : 0].end;
  const double beyond_m = at_to ? place.s_m - pipe.length_m : -place.s_m;  // negative: before the joint
  const Pipe& next = bore_.network().pipe(there.pipe);
  ShapePlace into = place;
  into.pipe = there.pipe;
  into.s_m = there.at_to ? next.length_m - beyond_m : beyond_m;
  if (there.at_to == at_to) into.sense = -place.sense;
  into.p_LG += bore_.ShiftAcross(here, there);
  PlaceInPipe(into, shape);
  PlaceBeyond(into, !there.at_to, shape);
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
         wall(spot).profile.IsUniform(spot.s_m - window_m, spot.s_m + window_m) &&
         FindPiece(spot).features.IsClear(spot.s_m - window_m, spot.s_m + window_m);
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
  WallFeet feet;
  if (end.joint && CalcEndDistance_m(spot) < end.reach_m + limit_m) {
    feet = FindFeetAtJoint(spot, p_F, p, limit_m, end);
  } else {
    wall(spot).profile.AddFeet(p, limit_m, kContactRange_m, feet);
    AddPlate(spot, p, feet);
  }
  FindPiece(spot).features.Apply(p, p_F, limit_m, kContactRange_m, feet);
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
    feet.Add({R_LF.transpose() * foot.normal, foot.distance_m, foot.kind, foot.feature, foot.body});
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
  const WallFoot* continued = FindContinued(feet, to.normal_F, foot.body);
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
