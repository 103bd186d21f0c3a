#pragma once

#include <array>
#include <memory>
#include <vector>

#include "sim/bore_profile.h"
#include "sim/feature_line.h"
#include "sim/joint_wall.h"
#include "sim/network_spot.h"

namespace piperun::sim {

/// Contact of a sphere with the wall, in the frame F of the piece it is in.
struct WallContact {
  Vector3d normal_F;  ///< unit, from the wall to the sphere
  double gap_m = 0;   ///< between the sphere and the wall where the sphere is about to be; negative: overlap
  int feature = -1;   ///< as in WallFoot
  double present_gap_m = 0;  ///< where the sphere is now
};

/// The contacts of one step: the few with the smallest gaps.
class WallContacts {
 public:
  static constexpr std::size_t kCapacity = 4;

  void Add(const WallContact& contact);

  const WallContact* begin() const { return contacts_.data(); }
  const WallContact* end() const { return contacts_.data() + size_; }
  std::size_t size() const { return size_; }

  /// The sphere's centre had left the water; the only contact leads back. Never so in a network whose bores
  /// leave the ball room and whose pipes are longer than their joints.
  bool rescue = false;

 private:
  std::array<WallContact, kCapacity> contacts_;
  std::size_t size_ = 0;
};

/// The wall of a network's bores, exact: cylinders around straight pieces, tori around bends, cones
/// (sim/bore_profile.h), unions of bores with their edges where pipes meet, plates in pipes that are shut
/// (sim/joint_wall.h), and the features on it (sim/feature_shape.h).
///
/// Every piece of every pipe has its own frame F, so that the wall is found from the small coordinates across
/// the pipe and rounding does not grow with the distance from the origin of the drawing L. On a straight, F
/// sits at its beginning with x along the axis; in a bend, at the bend's centre with z normal to its plane
/// and the bend beginning on x.
class BoreWall {
 public:
  static constexpr double kContactRange_m = 0.002;

  /// Keeps a reference to the bore.
  explicit BoreWall(const Bore& bore);

  const Bore& bore() const { return bore_; }
  const Pose& X_LF(const NetworkSpot& spot) const { return FindPiece(spot).X_LF; }
  const Pose& X_FL(const NetworkSpot& spot) const { return FindPiece(spot).X_FL; }
  const Matrix3d& R_LF(const NetworkSpot& spot) const { return FindPiece(spot).R_LF; }

  /// The points of the wall at most `limit_m` away that are locally nearest to p_F: on walls facing it, and
  /// on edges. On the axis, where no wall is nearest, those in the direction `sideways_F`; none when that is
  /// zero, too. When p lies outside of the water, the way back (distance < 0) is the only one.
  WallFeet FindFeet(const NetworkSpot& spot, const Vector3d& p_F, const Vector3d& sideways_F,
                    double limit_m) const;

  /// Contacts of a sphere at p_F, moving with v_F, over the coming step dt, as constraints on positions (like
  /// SHAKE):
  ///
  ///   v_t = v - n (v . n),  p' = p + v_t dt,  gap = |p' - q'| - r
  ///
  /// n taken at p, q' the foot of p' on the same wall or on what it goes over into. A contact that makes the
  /// normal velocity -gap/dt puts the sphere on the curved wall at the end of the step, where the tangent at
  /// p would leave it; so position and velocity agree. Contacts that the step cannot close to within
  /// kContactRange_m are left out. No allocation.
  WallContacts Probe(const NetworkSpot& spot, const Vector3d& p_F, const Vector3d& v_F, double radius_m,
                     double dt_s) const;

 private:
  struct Piece {
    Pose X_LF, X_FL;
    Matrix3d R_LF;
    double bend_radius_m = 0;  // 0 on a straight
    FeatureLine features;
  };
  /// A shape's frame G in the drawing of the pipe it is felt in, and from where to where it reaches there.
  struct ShapePlace {
    int pipe = 0;
    double s_m = 0;
    double sense = 1;  // -1: the pipe's s runs against x of G
    Vector3d p_LG;
    Matrix3d R_LG;
    ShapeExtent extent;
  };
  /// What happens at one end of a pipe.
  struct End {
    const JointWall* joint = nullptr;  // null: nothing but the pipe's own wall
    std::size_t arm = 0;
    double reach_m = 0;
    Vector3d p_node_L;
    double plate_s_m = 0;
  };
  struct PipeWall {
    std::size_t first_piece = 0;
    double radius_m = 0;
    BoreProfile profile;
    std::array<End, 2> ends;  // from, to
  };
  /// Where a step leads: pipe and piece, and the foot's normal and the new position in that piece's frame.
  struct Landing {
    NetworkSpot spot;
    Vector3d p_F;
    Vector3d normal_F;
  };

  void AddPipe(int pipe);
  End MakeEnd(int pipe, bool at_to) const;
  static Piece MakePiece(const CentrelinePiece& line);
  void PlaceFeatures();
  ShapePlace MakePlace(int pipe, const FeatureShape& shape) const;
  void PlaceInPipe(const ShapePlace& place, PlacedShape shape);
  void PlaceBeyond(const ShapePlace& place, bool at_to, const PlacedShape& shape);
  const Piece& FindPiece(const NetworkSpot& spot) const {
    return pieces_[wall(spot).first_piece + spot.piece];
  }
  const PipeWall& wall(const NetworkSpot& spot) const { return walls_[static_cast<std::size_t>(spot.pipe)]; }
  const End& NearEnd(const NetworkSpot& spot) const;
  double CalcEndDistance_m(const NetworkSpot& spot) const;
  /// Nothing but one tube is felt within `window_m` along the pipe.
  bool IsPlain(const NetworkSpot& spot, double window_m) const;
  static Vector3d CalcOffset(const Piece& piece, const Vector3d& p_F);
  static double CalcAdvance_m(const Piece& piece, const Vector3d& from_F, const Vector3d& to_F);
  PipePoint MakePipePoint(const NetworkSpot& spot, const Vector3d& p_F, const Vector3d& sideways_F) const;
  void AddPlate(const NetworkSpot& spot, const PipePoint& p, WallFeet& feet) const;
  WallFeet FindFeetAtJoint(const NetworkSpot& spot, const Vector3d& p_F, const PipePoint& p, double limit_m,
                           const End& end) const;
  Landing Land(const NetworkSpot& spot, const Vector3d& p_F, const Vector3d& step_F,
               const Vector3d& normal_F) const;
  double PredictDistance(const NetworkSpot& spot, const Vector3d& p_F, const WallFoot& foot,
                         const Vector3d& step_F) const;
  WallContacts ProbeTube(const NetworkSpot& spot, const Vector3d& p_F, const Vector3d& v_F, double radius_m,
                         double dt_s) const;

  const Bore& bore_;
  std::vector<Piece> pieces_;
  std::vector<PipeWall> walls_;
  std::vector<std::unique_ptr<const JointWall>> joints_;  // per node; null at smooth ones
};

}  // namespace piperun::sim
