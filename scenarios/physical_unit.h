#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace piperun::scenarios {

/// A unit as data sheets and log files write it: its value in SI and its dimensions. The radian counts as
/// one, so that deg/sqrt(h) is told from 1/sqrt(h).
struct PhysicalUnit {
  double factor = 1;  ///< value in this unit times factor = value in SI
  /// Exponents of rad, m, s, T, Pa, K.
  std::array<double, 6> exponents{};

  friend bool operator==(const PhysicalUnit&, const PhysicalUnit&) = default;
  bool SameDimension(const PhysicalUnit& other) const { return exponents == other.exponents; }
};

/// Reads "deg/s/sqrt(Hz)", "deg/h", "deg/sqrt(h)", "ug/sqrt(Hz)", "mdps/rtHz", "m/s/sqrt(h)", "rad s^-1",
/// "uT", "ppm": names multiplied by blanks or '*', each '/' dividing by the one name after it, powers as
/// "^-1.5", sqrt(..) or rt.. for roots. g is standard gravity, 9.80665 m/s^2; G is gauss; dps is deg/s.
/// Throws InputError naming the part it does not know and the nearest it does, at `key_path`.
PhysicalUnit ParseUnit(std::string_view text, const std::string& key_path);

/// The SI unit of these dimensions as this project writes it: "rad/s/sqrt(Hz)"; "1" for a plain number.
std::string SiUnitText(const PhysicalUnit& unit);

/// Units in which data sheets give this quantity, the usual one first; empty when there are none.
std::vector<std::string_view> DataSheetUnits(const PhysicalUnit& unit);

/// What "% of full scale" and "LSB" refer to.
struct FullScale {
  std::optional<double> range_si;  ///< the reading goes from -range to +range
  std::string range_unit{"1"};     ///< SI
  std::optional<int> bits;         ///< of the output register: LSB = 2 range / 2^bits
};

struct SiValue {
  double value = 0;
  PhysicalUnit unit;  ///< SI: its factor is 1
};

/// A data-sheet value in SI. `unit` may also be %FS or LSB, times whatever follows ("LSB/sqrt(Hz)"), which
/// need `scale`; throws InputError when it is not given.
SiValue ConvertToSi(double value, std::string_view unit, const FullScale& scale);

}  // namespace piperun::scenarios
