#include "scenarios/truth_log.h"

#include <array>
#include <charconv>
#include <fstream>
#include <sstream>

#include "base/check.h"
#include "base/number.h"
#include "scenarios/csv_headers.h"
#include "scenarios/csv_reader.h"

namespace piperun::scenarios {
namespace {

struct TruthRow {
  TrueTime time{};
  TrackTruth truth{};
};

/// Columns of truth/ball.csv after stamp and pipe: s, chainage, p, q, and eleven more.
std::optional<TruthRow> ReadRow(CsvReader& reader) {
  std::array<double, 20> v{};
  std::string pipe;
  std::int64_t stamp = 0;
  if (!reader.Next(stamp, v, &pipe)) return std::nullopt;
  return TruthRow{TrueTime(Duration(stamp)),
                  {Quaterniond(v[5], v[6], v[7], v[8]), Vector3d(v[2], v[3], v[4]), v[1]}};
}

TrackTruth Blend(const TruthRow& a, const TruthRow& b, TrueTime t) {
  const double u = static_cast<double>((t - a.time).count()) / static_cast<double>((b.time - a.time).count());
  return {a.truth.q_WB.slerp(u, b.truth.q_WB), a.truth.p_W + u * (b.truth.p_W - a.truth.p_W),
          a.truth.chainage_m + u * (b.truth.chainage_m - a.truth.chainage_m)};
}

}  // namespace

struct TruthLog::Impl {
  explicit Impl(const std::filesystem::path& file)
      : reader(file, kBallHeader), before(ReadRow(reader)), after(before) {}
  CsvReader reader;
  std::optional<TruthRow> before;
  std::optional<TruthRow> after;
};

TruthLog::TruthLog(const std::filesystem::path& file) : impl_(std::make_unique<Impl>(file)) {}
TruthLog::~TruthLog() = default;

std::optional<TrackTruth> TruthLog::At(TrueTime t) {
  auto& before = impl_->before;
  auto& after = impl_->after;
  while (after && after->time <= t) {
    before = after;
    after = ReadRow(impl_->reader);
  }
  if (!before || t < before->time) return std::nullopt;
  if (t == before->time) return before->truth;
  if (!after) return std::nullopt;
  return Blend(*before, *after, t);
}

std::function<std::optional<TrackTruth>(RobotTime)> OpenTruth(const std::filesystem::path& file,
                                                              const ClockModel& clock) {
  return [log = std::make_shared<TruthLog>(file), clock](RobotTime t) { return log->At(clock.ToTrue(t)); };
}

std::vector<TrueLeak> LoadTrueLeaks(const std::filesystem::path& path) {
  std::ifstream file(path);
  if (!file) throw InputError("cannot read this file", "", path.string());
  std::vector<TrueLeak> leaks;
  std::string line;
  std::getline(file, line);  // header
  while (std::getline(file, line)) {
    std::stringstream fields(line);
    std::array<std::string, 10> f;
    for (std::string& field : f) std::getline(fields, field, ',');
    const auto number = [&](std::size_t i) {
      const auto value = ParseNumber(f[i]);
      if (!value) throw InputError("'" + f[i] + "' is not a number", "", path.string());
      return *value;
    };
    TrueLeak leak;
    leak.id = f[0];
    leak.pipe = f[1];
    leak.s_m = number(2);
    if (!f[3].empty()) leak.chainage_m = number(3);
    leak.p_W = {number(4), number(5), number(6)};
    leak.flow_m3_s = number(7);
    if (!f[8].empty()) leak.t_cpa_ns = static_cast<std::int64_t>(number(8));
    if (!f[9].empty()) leak.snr_dB = number(9);
    leaks.push_back(std::move(leak));
  }
  return leaks;
}

}  // namespace piperun::scenarios
