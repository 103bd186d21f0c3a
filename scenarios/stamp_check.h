#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scenarios/static_record.h"

namespace piperun::scenarios {

/// What to do with a row, by its stamp.
enum class StampVerdict { kNext, kStartsSegment, kDuplicate };

/// An even grid of times: its period, and how late the first stamp lies on it.
struct StampGrid {
  double period_s = 0;
  double first_off_s = 0;
};

/// Watches the stamps of a record: which numbers of an even grid of times they skip, and how far they lie off
/// it. The grid is a loop of second order that follows the stamps with a memory of 100: neither jitter of up
/// to 0.4 periods makes a gap, nor a clock's drift. A gap of no whole number of periods moves the grid.
class StampCheck {
 public:
  explicit StampCheck(const StampGrid& grid) : grid_(grid) {}
  /// Throws InputError at `where` when the stamp lies before the last one.
  StampVerdict Take(std::int64_t stamp_ns, RecordTiming& timing, const std::string& where);
  /// The next row does not follow: one was left out. Its interval is a gap whatever its length.
  void Break() { broken_ = true; }
  void Summarise(RecordTiming& timing) const;

 private:
  void MoveGrid(double by_s);

  StampGrid grid_;  ///< the period follows the stamps, too, but slowly
  bool any_ = false;
  bool broken_ = false;
  std::int64_t last_ns_ = 0;
  std::int64_t grid_ns_ = 0;  ///< whole part of the grid's time at the last stamp
  double grid_s_ = 0;         ///< beyond that
  std::int64_t stamps_ = 0, steps_ = 0;
  double covered_s_ = 0;  ///< by the grid
  double squares_s2_ = 0, largest_s_ = 0;
};

/// The grid of stamps that may jitter, skip and repeat. Its period: if they lie within half a period of a
/// straight line, its slope; else the median of their intervals, then of ever longer spans (4, 16 .. 256
/// stamps) over the whole number of periods nearest to them; zero when no stamp rises. The offset is that of
/// the first hundred's circular mean.
StampGrid FindStampGrid(const std::vector<std::int64_t>& stamps_ns);

}  // namespace piperun::scenarios
