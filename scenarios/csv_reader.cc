#include "scenarios/csv_reader.h"

#include <charconv>
#include <string_view>

#include "base/check.h"
#include "base/number.h"

namespace piperun::scenarios {
namespace {

std::string_view TakeField(std::string_view& rest) {
  const std::size_t comma = rest.find(',');
  const std::string_view field = rest.substr(0, comma);
  rest = comma == std::string_view::npos ? std::string_view{} : rest.substr(comma + 1);
  return field;
}

}  // namespace

CsvReader::CsvReader(const std::filesystem::path& path, std::string_view header, StampOrder order)
    : path_(path), order_(order), file_(path, std::ios::binary) {
  if (!file_) throw InputError("cannot read this file", "", path.string());
  while (!header.empty() && header.back() == '\n') header.remove_suffix(1);
  if (!ReadLine() || line_ != header) Refuse("the first line must be '" + std::string(header) + "'");
}

bool CsvReader::ReadLine() {
  if (!std::getline(file_, line_)) return false;
  ++line_number_;
  if (file_.eof()) Refuse("the file ends in the middle of a row");
  if (!line_.empty() && line_.back() == '\r') line_.pop_back();
  return true;
}

void CsvReader::Refuse(const std::string& problem) const {
  throw InputError(problem, "", path_.string() + ":" + std::to_string(line_number_));
}

void CsvReader::CheckOrder(std::int64_t stamp_ns) {
  if (before_ns_ && order_ == StampOrder::kRise && stamp_ns <= *before_ns_)
    Refuse("stamps must rise from row to row");
  if (before_ns_ && stamp_ns < *before_ns_) Refuse("stamps must not fall from row to row");
  before_ns_ = stamp_ns;
}

bool CsvReader::Next(std::int64_t& stamp_ns, std::span<double> values, std::string* text) {
  if (!ReadLine()) return false;
  std::string_view rest = line_;
  const std::string_view stamp = TakeField(rest);
  const auto [end, error] = std::from_chars(stamp.data(), stamp.data() + stamp.size(), stamp_ns);
  if (error != std::errc{} || end != stamp.data() + stamp.size())
    Refuse("the row does not begin with a stamp");
  CheckOrder(stamp_ns);
  if (text) *text = TakeField(rest);
  for (double& value : values) {
    const auto number = ParseNumber(TakeField(rest));
    if (!number) Refuse("a value is missing or is not a number");
    value = *number;
  }
  if (!rest.empty()) Refuse("the row has too many values");
  return true;
}

}  // namespace piperun::scenarios
