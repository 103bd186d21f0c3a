#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "scenarios/static_record.h"

namespace piperun::scenarios {

struct RecordColumn {
  std::size_t field = 0;  ///< place in the row
  double factor = 1;      ///< to SI
};

/// Which fields of a CSV row are what.
struct RecordLayout {
  std::vector<RecordGroup> groups;
  std::vector<RecordColumn> columns;  ///< of all groups, one after the other
  std::size_t fields = 0;
  std::optional<std::size_t> time_field;
  double time_unit_ns = 1e9;
  bool time_unit_told = false;  ///< by the header or the user
  bool has_header = false;
  std::vector<std::string> notes;  ///< columns left out because their unit is none
};

/// Reads the layout off the first line of a file and the user's options. Throws InputError when a column is
/// not there, a unit is missing or unknown, or there is neither time nor rate.
RecordLayout ReadRecordLayout(std::string_view first_line, const StaticRecordOptions& options,
                              const std::string& where);

/// Empty, nan or inf in any of the ways that people and programs write them.
bool IsNotFinite(std::string_view text);

}  // namespace piperun::scenarios
