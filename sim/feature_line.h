#pragma once

#include <cstdint>
#include <vector>

#include "sim/bore_profile.h"
#include "sim/feature_shape.h"

namespace piperun::sim {

/// A shape in the frame F of the piece of a pipe that it is felt in.
struct PlacedShape {
  double s_m = 0;                 ///< along the pipe of that piece; may lie beyond its ends
  double begin_m = 0, end_m = 0;  ///< s between which it reaches
  Vector3d p_FG = Vector3d::Zero();
  Matrix3d R_GF = Matrix3d::Identity();
  int feature = -1;  ///< index of the wall feature
  int body = -1;     ///< index of the shape among all shapes; WallFoot::body of what stands on the wall
  const ShapeBody* shape = nullptr;
};

/// The shapes that are felt along one piece of a pipe. Where none is near, finding that out takes one look
/// into a table and one comparison, whatever their number.
class FeatureLine {
 public:
  void Add(const PlacedShape& shape) { shapes_.push_back(shape); }
  /// After the last Add: sorts the shapes. `cell_m`: width of the table's cells.
  void Finish(double cell_m);

  /// No shape reaches into [a, b].
  bool IsClear(double a_m, double b_m) const;

  /// Takes from `feet` the feet on the pipe's own wall that lie where the wall has receded, and adds those on
  /// the shapes at most `limit_m` along the pipe away. `p` and `p_F` are one point.
  void Apply(const PipePoint& p, const Vector3d& p_F, double limit_m, double ring_m, WallFeet& feet) const;

 private:
  std::size_t FindFirst(double a_m) const;
  static WallFeet Recede(const PlacedShape& placed, const PipePoint& p, const Vector3d& p_F,
                         const WallFeet& feet);
  static void AddFeet(const PlacedShape& placed, const Vector3d& p_F, double limit_m, double ring_m,
                      WallFeet& feet);

  std::vector<PlacedShape> shapes_;   // begins rise
  std::vector<std::uint32_t> first_;  // per cell: the first shape that ends behind the cell's begin
  double origin_m_ = 0;
  double cell_m_ = 1;
};

}  // namespace piperun::sim
