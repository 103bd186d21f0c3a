#include "scenarios/truth_recorder.h"

#include <algorithm>
#include <cmath>

#include "scenarios/csv_headers.h"
#include "scenarios/csv_row.h"

namespace piperun::scenarios {
namespace {

constexpr std::string_view kGroundtruthHeader =
    "#timestamp,p_RS_R_x [m],p_RS_R_y [m],p_RS_R_z [m],q_RS_w [],q_RS_x [],q_RS_y [],q_RS_z [],"
    "v_RS_R_x [m s^-1],v_RS_R_y [m s^-1],v_RS_R_z [m s^-1],b_w_RS_S_x [rad s^-1],b_w_RS_S_y [rad s^-1],"
    "b_w_RS_S_z [rad s^-1],b_a_RS_S_x [m s^-2],b_a_RS_S_y [m s^-2],b_a_RS_S_z [m s^-2]\n";
constexpr std::string_view kLeaksHeader = "id,pipe,s_m,chainage_m,x_m,y_m,z_m,flow_m3_s,t_cpa_ns,snr_dB\n";
constexpr std::string_view kLabelsHeader = "id,begin_ns,t_cpa_ns,end_ns,snr_dB,snr_stems_dB\n";
constexpr std::string_view kFeaturesHeader = "id,kind,pipe,s_m,chainage_m\n";

std::int64_t Nanoseconds(TrueTime t) { return t.time_since_epoch().count(); }

/// True when the way taken is the planned one as far as it goes.
bool FollowsPlan(const sim::Way& way, const Route& plan) {
  const auto same = [](const sim::WayLeg& a, const RouteLeg& b) {
    return a.pipe == b.pipe && a.reversed == b.reversed;
  };
  return way.legs().size() <= plan.legs().size() &&
         std::equal(way.legs().begin(), way.legs().end(), plan.legs().begin(), same);
}

void WriteLeak(OutputFile& file, const TrueLeak& leak) {
  CsvRow(file) << std::string_view(leak.id) << std::string_view(leak.pipe) << leak.s_m << leak.chainage_m
               << leak.p_W << leak.flow_m3_s << leak.t_cpa_ns << leak.snr_dB << kEndOfRow;
}

void WriteLabel(OutputFile& file, const TrueLeak& leak, const Passage& passage,
                std::optional<double> snr_stems_dB) {
  std::optional<std::int64_t> begin_ns, end_ns;
  if (passage.heard) {
    begin_ns = Nanoseconds(passage.heard->begin);
    end_ns = Nanoseconds(passage.heard->end);
  }
  CsvRow(file) << std::string_view(leak.id) << begin_ns << leak.t_cpa_ns << end_ns << leak.snr_dB
               << snr_stems_dB << kEndOfRow;
}

/// Of the wall features, by index.
std::vector<std::string> FeatureIds(const Assembly& assembly) {
  std::vector<std::string> ids;
  for (const WallFeatureLabel& feature : assembly.wall_features) ids.push_back(feature.id);
  return ids;
}

}  // namespace

TruthRecorder::TruthRecorder(const Assembly& assembly, Rate truth_rate,
                             const std::filesystem::path& truth_folder,
                             const std::filesystem::path& groundtruth_folder)
    : assembly_(assembly),
      truth_rate_(truth_rate),
      truth_folder_(truth_folder),
      ball_(truth_folder / "ball.csv"),
      groundtruth_(groundtruth_folder / "data.csv"),
      passages_(assembly) {
  ball_.Append(kBallHeader);
  groundtruth_.Append(kGroundtruthHeader);
  if (assembly.motion->way())
    contacts_.emplace(truth_folder / "contacts.csv", *assembly.network(), FeatureIds(assembly));
}

std::optional<ContactSummary> TruthRecorder::contacts() const {
  return contacts_ ? std::optional(contacts_->summary()) : std::nullopt;
}

void TruthRecorder::Watch(const sim::TruthWindow& window) {
  passages_.Watch(window.at(window.last()));
  if (contacts_) contacts_->WriteUntil(window.latest_time());
}

void TruthRecorder::WriteUntil(TrueTime horizon, const sim::TruthWindow& window) {
  for (;; ++next_row_) {
    const TrueTime due = SampleTime(next_row_, truth_rate_);
    if (due > horizon) return;
    WriteRow(sim::Interpolate(window, due));
  }
}

void TruthRecorder::WriteRow(const sim::TruthState& state) {
  static const std::string kNoPipe = "-";
  const std::string& pipe = state.pipe < 0 ? kNoPipe : assembly_.network()->pipe(state.pipe).id;
  CsvRow(ball_) << Nanoseconds(state.time) << std::string_view(pipe) << state.s_m << state.chainage_m
                << state.X_WB.p << state.X_WB.q << state.v_WB_W << state.w_WB_B << state.f_WB_B
                << state.water_speed_m_s << static_cast<std::int64_t>(state.contact) << kEndOfRow;
  const Pose X_BS = assembly_.imu ? assembly_.imu->sensor().X_BS() : Pose{};
  const auto bias = assembly_.imu ? assembly_.imu->sensor().bias() : std::nullopt;
  const Pose X_WS = state.X_WB * X_BS;
  const Vector3d v_WS_W = state.v_WB_W + state.X_WB.q * state.w_WB_B.cross(X_BS.p);
  CsvRow(groundtruth_) << Nanoseconds(state.time) << X_WS.p << X_WS.q << v_WS_W
                       << (bias ? bias->gyro_rad_s : Vector3d::Zero().eval())
                       << (bias ? bias->accel_m_s2 : Vector3d::Zero().eval()) << kEndOfRow;
}

/// Where a place lies on the way taken, or on what was still to come of the planned one; in the drawing, and
/// without a chainage, when it lies on neither.
TruthRecorder::Place TruthRecorder::FindPlace(int pipe, double s_m) const {
  const Vector3d p_L = assembly_.network()->pipe(pipe).Eval(s_m).p_W;
  const sim::Way* way = assembly_.motion->way();
  const auto planned = assembly_.plan->Chainage(pipe, s_m);
  if (way) {
    if (const sim::WayLeg* leg = way->FindLeg(pipe)) {
      return {way->CalcChainage_m(*leg, s_m), p_L + leg->offset_W};
    }
    if (!FollowsPlan(*way, *assembly_.plan)) return {std::nullopt, p_L};
  }
  if (!planned) return {std::nullopt, p_L};
  return {planned, assembly_.plan->Eval(*planned).p_W};
}

void TruthRecorder::WriteFeatures() const {
  OutputFile file(truth_folder_ / "features.csv");
  file.Append(kFeaturesHeader);
  for (const WallFeatureLabel& feature : assembly_.wall_features) {
    CsvRow(file) << std::string_view(feature.id) << std::string_view(feature.kind)
                 << std::string_view(assembly_.network()->pipe(feature.pipe).id) << feature.s_m
                 << FindPlace(feature.pipe, feature.s_m).chainage_m << kEndOfRow;
  }
  file.Close();
}

std::vector<TrueLeak> TruthRecorder::Close(const StemSnr* stems) {
  ball_.Close();
  groundtruth_.Close();
  if (!assembly_.wall_features.empty()) WriteFeatures();
  if (contacts_) contacts_->Close();
  OutputFile file(truth_folder_ / "leaks.csv"), labels(truth_folder_ / "labels.csv");
  file.Append(kLeaksHeader);
  labels.Append(kLabelsHeader);
  std::vector<TrueLeak> leaks;
  const std::size_t count = assembly_.pipeline ? assembly_.pipeline->leaks.size() : 0;
  for (std::size_t i = 0; i < count; ++i) {
    const Leak& at = assembly_.pipeline->leaks[i];
    const Place place = FindPlace(at.pipe, at.s_m);
    TrueLeak leak{at.id,     assembly_.network()->pipe(at.pipe).id,        at.s_m,       place.chainage_m,
                  place.p_W, assembly_.pipeline->leak_states[i].flow_m3_s, std::nullopt, std::nullopt};
    const auto passage = place.chainage_m ? passages_.Find(i) : std::nullopt;
    if (passage && passage->passed) {
      leak.t_cpa_ns = Nanoseconds(*passage->passed);
      leak.snr_dB = passage->snr_dB;
      WriteLabel(labels, leak, *passage, stems ? stems->Measure_dB(i, *passage->passed) : std::nullopt);
    }
    WriteLeak(file, leak);
    leaks.push_back(std::move(leak));
  }
  file.Close();
  labels.Close();
  return leaks;
}

}  // namespace piperun::scenarios
