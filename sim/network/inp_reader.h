#pragma once

#include <cstdint>
#include <string_view>

#include "sim/network/model.h"

namespace piperun::sim {

/// The greatest text ReadInp takes, some ten times the largest network in public use.
inline constexpr std::size_t kMaxInpBytes = 32u << 20;

/// Throws the InputError of a text that is too long: whoever has a file may ask for its size before reading
/// it.
[[noreturn]] void RefuseSize(std::uintmax_t bytes, std::string_view name);

/// Reads an EPANET 2.2 or 2.3 input file: every section, US and SI units, comments, Latin-1 or UTF-8, any
/// order, keywords in any case and cut to EPANET's stems. Numbers become SI the way EPANET reads them (its
/// rounded unit constants, epanet_constants.h), so that results agree with EPANET's. `name` stands in
/// messages. What has no bearing on hydraulics is listed in HydraulicModel::notes; everything else is
/// honoured or refused.
///
/// Throws InputError with file, line and section for whatever cannot be read or makes no network: bytes that
/// are no text, more than kMaxInpBytes, unknown sections, keywords, units, nodes, links, patterns or curves,
/// ids used twice, sizes <= 0, pump curves that do not fall, tank levels that disagree, valves in impossible
/// places, a part without reservoir or tank.
HydraulicModel ReadInp(std::string_view text, std::string_view name);

}  // namespace piperun::sim
