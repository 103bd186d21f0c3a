#include "scenarios/static_record.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <deque>
#include <fstream>

#include "acoustics/audio_file.h"
#include "base/check.h"
#include "base/number.h"
#include "scenarios/record_columns.h"
#include "scenarios/record_unit.h"
#include "scenarios/stamp_check.h"

namespace piperun::scenarios {
namespace {

constexpr std::size_t kBlock = 4096;
constexpr std::size_t kRowsToFindThePeriod = 1024;
constexpr std::int64_t kRowsBeforeJudging = 1000;
constexpr double kMostLeftOut = 0.01;
constexpr double kLongestLikelyPeriod_s = 100;

enum class RowState { kOk, kNotFinite, kCorrupt };

struct Row {
  std::int64_t line = 0;
  std::int64_t stamp_ns = 0;
  RowState state = RowState::kOk;
  std::vector<double> values;
};

std::string_view Trim(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" \t\r");
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(" \t\r") - begin + 1);
}

RowState ReadValue(std::string_view text, double& value) {
  const auto number = ParseNumber(Trim(text));
  if (!number) return IsNotFinite(Trim(text)) ? RowState::kNotFinite : RowState::kCorrupt;
  value = *number;
  return RowState::kOk;
}

/// Whole stamps stay whole: nanoseconds since 1970 are more than a double holds.
bool ReadStamp(std::string_view text, double unit_ns, std::int64_t& stamp_ns) {
  text = Trim(text);
  std::int64_t whole = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), whole);
  if (error == std::errc{} && end == text.data() + text.size()) {
    return !__builtin_mul_overflow(whole, static_cast<std::int64_t>(unit_ns), &stamp_ns);
  }
  const auto number = ParseNumber(text);
  if (!number || std::abs(*number * unit_ns) > 9e18) return false;
  stamp_ns = std::llround(*number * unit_ns);
  return true;
}

void Count(RecordTrouble& trouble, const std::string& where) {
  if (trouble.count++ == 0) trouble.first = where;
}

class CsvRecord final : public StaticRecord {
 public:
  CsvRecord(const std::filesystem::path& path, const StaticRecordOptions& options)
      : path_(path), file_(path, std::ios::binary) {
    std::error_code ignored;
    size_ = static_cast<double>(std::filesystem::file_size(path, ignored));
    if (!file_ || !std::getline(file_, line_))
      throw InputError("cannot read this file, or it is empty", "", path.string());
    layout_ = ReadRecordLayout(line_, options, path.string() + ":1");
    if (layout_.has_header) {
      line_number_ = 1;
    } else {
      file_.seekg(0);
    }
    Prefetch();
    if (layout_.time_field && !layout_.time_unit_told) RefuseUnlikelySeconds();
    if (options.rate_Hz) grid_.period_s = 1 / *options.rate_Hz;
    if (waiting_.empty()) throw InputError("there is no row of data", "", path.string());
    if (!(grid_.period_s > 0))
      throw InputError("the time stamps do not rise; add --rate HZ", "--rate", path.string());
    stamps_.emplace(grid_);
    timing_.period_s = grid_.period_s;
  }

  const std::vector<RecordGroup>& groups() const override { return layout_.groups; }
  const RecordTiming& timing() const override { return timing_; }
  std::vector<std::string> notes() const override { return layout_.notes; }
  double progress() const override { return size_ > 0 ? position_ / size_ : 1; }

  bool Next(RecordBlock& block) override {
    block.channels.assign(layout_.columns.size(), {});
    block.starts_segment = std::exchange(segment_waits_, false);
    std::size_t rows = 0;
    if (carried_) {
      Append(block, *std::exchange(carried_, std::nullopt));
      rows = 1;
    }
    Row row;
    while (rows < kBlock && TakeRow(row)) {
      if (!Accept(row)) continue;
      if (starts_segment_ && rows > 0) {
        carried_ = row;
        segment_waits_ = true;
        break;
      }
      block.starts_segment |= std::exchange(starts_segment_, false);
      Append(block, row);
      ++rows;
    }
    starts_segment_ = false;
    position_ = file_.good() ? static_cast<double>(file_.tellg()) : size_;
    timing_.rows += static_cast<std::int64_t>(rows);
    if (rows == 0) Finish();
    return rows > 0;
  }

 private:
  std::string Where(std::int64_t line) const { return path_.string() + ":" + std::to_string(line); }

  /// Looks ahead, to learn the period from the stamps.
  void Prefetch() {
    Row row;
    std::vector<std::int64_t> stamps_ns;
    while (waiting_.size() < kRowsToFindThePeriod && ReadRow(row)) {
      if (row.state != RowState::kCorrupt) stamps_ns.push_back(row.stamp_ns);
      waiting_.push_back(row);
    }
    grid_ = FindStampGrid(stamps_ns);
  }

  /// Stamps whose unit nobody told are taken for seconds, unless that is absurd.
  void RefuseUnlikelySeconds() const {
    const bool unreadable = std::all_of(waiting_.begin(), waiting_.end(),
                                        [](const Row& row) { return row.state == RowState::kCorrupt; });
    if (!waiting_.empty() && !unreadable && !(grid_.period_s > kLongestLikelyPeriod_s)) return;
    if (waiting_.empty()) return;
    throw InputError(unreadable ? "the time stamps are no seconds since 1970; tell their unit: --time-unit ns"
                                : "the time stamps' unit is not told, and taken for seconds they lie " +
                                      FormatDigits(grid_.period_s, 3) +
                                      " s apart; tell it: --time-unit ns, us, ms or s",
                     "--time-unit", path_.string());
  }

  bool TakeRow(Row& row) {
    if (waiting_.empty()) return ReadRow(row);
    row = std::move(waiting_.front());
    waiting_.pop_front();
    return true;
  }

  /// The next row that is not empty and no comment.
  bool ReadRow(Row& row) {
    do {
      if (!std::getline(file_, line_)) return false;
      ++line_number_;
    } while (Trim(line_).empty() || line_.front() == '#');
    row.line = line_number_;
    row.state = ParseRow(row);
    return true;
  }

  RowState ParseRow(Row& row) {
    fields_.clear();
    std::string_view rest = line_;
    for (std::size_t comma = 0; comma != std::string_view::npos;) {
      comma = rest.find(',');
      fields_.push_back(rest.substr(0, comma));
      if (comma != std::string_view::npos) rest.remove_prefix(comma + 1);
    }
    if (fields_.size() != layout_.fields) return RowState::kCorrupt;
    if (layout_.time_field && !ReadStamp(fields_[*layout_.time_field], layout_.time_unit_ns, row.stamp_ns))
      return RowState::kCorrupt;
    row.values.resize(layout_.columns.size());
    RowState worst = RowState::kOk;
    for (std::size_t i = 0; i < row.values.size(); ++i) {
      worst = std::max(worst, ReadValue(fields_[layout_.columns[i].field], row.values[i]));
      row.values[i] *= layout_.columns[i].factor;
    }
    return worst;
  }

  /// Whether the row is a sample; sets starts_segment_ when it does not follow the one before.
  bool Accept(const Row& row) {
    ++rows_read_;
    if (row.state != RowState::kOk) {
      Count(row.state == RowState::kCorrupt ? timing_.corrupt : timing_.not_finite, Where(row.line));
      stamps_->Break();
      starts_segment_ = true;
      RefuseIfTooMany();
      return false;
    }
    if (!layout_.time_field) return true;
    const StampVerdict verdict = stamps_->Take(row.stamp_ns, timing_, Where(row.line));
    if (verdict == StampVerdict::kDuplicate) {
      Count(timing_.duplicated, Where(row.line));
      RefuseIfTooMany();
      return false;
    }
    starts_segment_ |= verdict == StampVerdict::kStartsSegment;
    return true;
  }

  void RefuseIfTooMany() const {
    if (rows_read_ >= kRowsBeforeJudging) RefuseIfMoreThan(kMostLeftOut);
  }

  void RefuseIfMoreThan(double share) const {
    const std::int64_t bad = timing_.corrupt.count + timing_.not_finite.count + timing_.duplicated.count;
    if (static_cast<double>(bad) <= share * static_cast<double>(rows_read_)) return;
    const auto& first = timing_.corrupt.count > 0      ? timing_.corrupt
                        : timing_.not_finite.count > 0 ? timing_.not_finite
                                                       : timing_.duplicated;
    throw InputError(std::to_string(bad) + " of " + std::to_string(rows_read_) +
                         " rows are corrupt, not finite or repeat a stamp; at most 1 % may be left out",
                     "", first.first);
  }

  void Append(RecordBlock& block, const Row& row) {
    for (std::size_t i = 0; i < row.values.size(); ++i) block.channels[i].push_back(row.values[i]);
  }

  void Finish() {
    RefuseIfMoreThan(rows_read_ < 100 ? 0.5 : kMostLeftOut);
    if (layout_.time_field) stamps_->Summarise(timing_);
  }

  std::filesystem::path path_;
  std::ifstream file_;
  std::string line_;
  std::vector<std::string_view> fields_;
  std::int64_t line_number_ = 0;
  std::int64_t rows_read_ = 0;
  RecordLayout layout_;
  std::deque<Row> waiting_;
  std::optional<Row> carried_;  ///< first of the next segment
  std::optional<StampCheck> stamps_;
  RecordTiming timing_;
  StampGrid grid_;
  double size_ = 0, position_ = 0;
  bool starts_segment_ = false, segment_waits_ = false;
};

class AudioRecord final : public StaticRecord {
 public:
  AudioRecord(const std::filesystem::path& path, const StaticRecordOptions& options) : reader_(path) {
    const bool named = !options.units.empty();
    const std::string group = named ? options.units[0].first : "audio";
    const auto [factor, si] = ResolveGroupUnit(group, named ? options.units[0].second : "1");
    groups_.push_back({group, si, {"1"}});
    scale_ = factor * options.full_scale / std::ldexp(1.0, static_cast<int>(reader_.format().bits) - 1);
    timing_.period_s = 1 / static_cast<double>(reader_.format().rate_Hz);
  }
  const std::vector<RecordGroup>& groups() const override { return groups_; }
  const RecordTiming& timing() const override { return timing_; }
  double progress() const override {
    return static_cast<double>(timing_.rows) /
           static_cast<double>(std::max<std::int64_t>(1, reader_.frames()));
  }
  bool Next(RecordBlock& block) override {
    const std::size_t n = reader_.Read(counts_);
    block.starts_segment = timing_.rows == 0;
    block.channels.assign(1, {});
    for (std::size_t i = 0; i < n; ++i) block.channels[0].push_back(scale_ * counts_[i]);
    timing_.rows += static_cast<std::int64_t>(n);
    return n > 0;
  }

 private:
  acoustics::AudioReader reader_;
  std::vector<RecordGroup> groups_;
  RecordTiming timing_;
  double scale_ = 1;
  std::array<std::int32_t, kBlock> counts_{};
};

/// The record within a folder.
std::filesystem::path FindRecordFile(const std::filesystem::path& path) {
  if (!std::filesystem::is_directory(path)) return path;
  for (const char* inside : {"mav0/imu0/data.csv", "imu0/data.csv", "data.csv"}) {
    if (std::filesystem::exists(path / inside)) return path / inside;
  }
  throw InputError("this folder holds neither mav0/imu0/data.csv nor data.csv; name the file", "",
                   path.string());
}

/// A group's columns or unit, given twice, would hide one of them.
template <class Value>
void RefuseTwice(const std::vector<std::pair<std::string, Value>>& given, const char* option) {
  for (std::size_t i = 0; i < given.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (given[i].first == given[j].first)
        throw InputError("'" + given[i].first + "' is given twice", option);
    }
  }
}

void RefuseUnitsOfNothing(const StaticRecord& record, const StaticRecordOptions& options) {
  for (const auto& [name, unit] : options.units) {
    const auto& groups = record.groups();
    if (std::any_of(groups.begin(), groups.end(),
                    [&, &name = name](const RecordGroup& g) { return g.name == name; }))
      continue;
    throw InputError("the record has no '" + name + "' to be in " + unit, "--unit");
  }
}

}  // namespace

std::unique_ptr<StaticRecord> OpenStaticRecord(const std::filesystem::path& path,
                                               const StaticRecordOptions& options) {
  if (options.rate_Hz && !(*options.rate_Hz > 0 && *options.rate_Hz <= 1e9)) {
    throw InputError(FormatNumber(*options.rate_Hz) + " is out of range; allowed: (0, 1e9]", "--rate");
  }
  RefuseTwice(options.columns, "--columns");
  RefuseTwice(options.units, "--unit");
  const std::filesystem::path file = FindRecordFile(path);
  const std::string extension = file.extension().string();
  std::unique_ptr<StaticRecord> record;
  if (extension == ".wav" || extension == ".flac") {
    record = std::make_unique<AudioRecord>(file, options);
  } else {
    record = std::make_unique<CsvRecord>(file, options);
  }
  RefuseUnitsOfNothing(*record, options);
  return record;
}

}  // namespace piperun::scenarios
