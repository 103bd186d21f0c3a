#pragma once

#include <array>
#include <vector>

#include "sim/network_spot.h"

namespace piperun::sim {

/// Strength of the flow across a pipe that bends make.
struct CrossStrength {
  Vector3d cells_W = Vector3d::Zero();  ///< of a pair of cells: core velocity over the bulk speed
  double swirl = 0;                     ///< of a single cell, 0 to 1; its sense switches (sim/swirl.h)

  bool IsZero() const { return cells_W.isZero(0) && swirl == 0; }
};

/// Strength at a place, and its derivative with s.
struct CrossGrowth {
  CrossStrength strength;
  CrossStrength slope_1_m;
};

/// How secondary flow comes and goes along the pipes of a network. Within a bend the vector a of the cells
/// relaxes within a diameter, behind it within five:
///
///   da/dx = (A g e - a)/D  in a bend,    da/dx = -a/(5 D)  on a straight,    g = min(1, 1.5 D/R_c)
///
/// x runs with the water, e points from the bend's centre outwards, and a is carried along the axis without
/// twist. The swirl obeys the same laws with A = 1. A is for bends of R_c <= 1.5 D; in gentler ones the
/// secondary vorticity is, as in Squire & Winter (J. Aeronaut. Sci. 18, 271 (1951)), in proportion to the
/// angle turned along a diameter. It goes on through smooth joints and begins at zero behind all others.
class SecondaryFlow {
 public:
  /// Keeps a reference.
  SecondaryFlow(const Bore& bore, double amplitude);

  /// `reversed`: the water runs from `to` to `from`. A pipe and what lies upstream of it are worked out when
  /// first met; nothing else allocates. Water that parts or meets at a smooth joint counts as running
  /// through.
  CrossGrowth Eval(const NetworkSpot& spot, bool reversed) const;
  /// False where there is no bend upstream, or none so near that anything were left of its flow.
  bool IsFelt(const NetworkSpot& spot, bool reversed) const;

 private:
  /// Where the water comes into a piece.
  struct Entry {
    CrossStrength strength;
    Vector3d normal_W = Vector3d::Zero();  // of a bend, there
  };
  struct Way {
    std::vector<Entry> entry;  // per piece
    CrossStrength exit;        // where the water leaves the pipe
    bool visited = false;      // a ring of smooth joints ends here
  };
  Way& FindOrMakeWay(int pipe, bool reversed) const;
  CrossStrength CalcEntry(int pipe, bool reversed) const;
  CrossGrowth EvalPiece(const Pipe& pipe, std::size_t piece, const Entry& entry, double s_m,
                        const CentrelinePoint& axis, bool reversed) const;

  const Bore& bore_;
  double amplitude_;
  mutable std::vector<std::array<Way, 2>> ways_;  // per pipe: with s, against s
};

}  // namespace piperun::sim
