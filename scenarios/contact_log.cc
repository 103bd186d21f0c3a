#include "scenarios/contact_log.h"

#include <algorithm>

#include "base/check.h"
#include "scenarios/csv_row.h"

namespace piperun::scenarios {
namespace {

constexpr std::string_view kContactsHeader =
    "#timestamp [ns],duration [s],pipe,s [m],chainage [m],p_W_x [m],p_W_y [m],p_W_z [m],"
    "impulse_W_x [N s],impulse_W_y [N s],impulse_W_z [N s],closing_speed [m s^-1],peak_force [N],feature\n";

}  // namespace

ContactLog::ContactLog(const std::filesystem::path& file, const Network& network,
                       std::vector<std::string> feature_ids)
    : file_(file), network_(network), feature_ids_(std::move(feature_ids)) {
  file_.Append(kContactsHeader);
}

void ContactLog::Add(const sim::ContactEvent& event) {
  const auto later = std::upper_bound(
      waiting_.begin(), waiting_.end(), event,
      [](const sim::ContactEvent& a, const sim::ContactEvent& b) { return a.begin < b.begin; });
  waiting_.insert(later, event);
}

void ContactLog::WriteUntil(TrueTime now) {
  const auto open = std::find_if(waiting_.begin(), waiting_.end(), [now](const sim::ContactEvent& event) {
    return event.begin + sim::kContactEventDelay >= now;
  });
  std::for_each(waiting_.begin(), open, [this](const sim::ContactEvent& event) { Write(event); });
  waiting_.erase(waiting_.begin(), open);
}

void ContactLog::Close() {
  WriteUntil(TrueTime::max());
  file_.Close();
}

std::string ContactLog::FeatureName(int feature) const {
  if (feature < 0) return "wall";
  return feature_ids_.at(static_cast<std::size_t>(feature));
}

void ContactLog::Write(const sim::ContactEvent& event) {
  Demand(event.pipe >= 0, "a ball strikes the wall of a pipe");
  CsvRow(file_) << event.begin.time_since_epoch().count() << event.duration_s
                << std::string_view(network_.pipe(event.pipe).id) << event.s_m << event.chainage_m
                << event.p_W << event.impulse_W_N_s << event.closing_speed_m_s << event.peak_force_N
                << std::string_view(FeatureName(event.feature)) << kEndOfRow;
  ++summary_.count;
  summary_.largest_impulse_N_s = std::max(summary_.largest_impulse_N_s, event.impulse_W_N_s.norm());
}

}  // namespace piperun::scenarios
