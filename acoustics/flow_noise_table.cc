#include "acoustics/flow_noise_table.h"

#include <cmath>
#include <utility>

#include "acoustics/flow_noise.h"

namespace piperun::acoustics {
namespace {

constexpr double kLogStep = 0.02;
constexpr std::int64_t kRows = 128;  // a span of speeds of 1 : 13 without recomputing

double RowSpeed_m_s(std::int64_t index) { return std::exp(kLogStep * static_cast<double>(index)); }

}  // namespace

FlowNoiseTable::FlowNoiseTable(const WaterProperties& water, double face_radius_m, double bin_width_Hz,
                               std::vector<double> gain)
    : water_(water), face_radius_m_(face_radius_m), bin_width_Hz_(bin_width_Hz), gain_(std::move(gain)) {
  rows_.resize(kRows);
  for (Row& row : rows_) row.psd.resize(gain_.size());
}

void FlowNoiseTable::AddTo(std::span<float> psd, double speed_m_s, double bore_radius_m) {
  if (speed_m_s <= 0) return;
  const auto below = static_cast<std::int64_t>(std::floor(std::log(speed_m_s) / kLogStep));
  const Row& slow = FindRow(below, bore_radius_m);
  const Row& fast = FindRow(below + 1, bore_radius_m);
  const double low_m_s = RowSpeed_m_s(below), high_m_s = RowSpeed_m_s(below + 1);
  const auto weight = static_cast<float>((speed_m_s - low_m_s) / (high_m_s - low_m_s));
  for (std::size_t k = 0; k < psd.size(); ++k) {
    psd[k] += slow.psd[k] + weight * (fast.psd[k] - slow.psd[k]);
  }
}

const FlowNoiseTable::Row& FlowNoiseTable::FindRow(std::int64_t index, double bore_radius_m) {
  Row& row = rows_[static_cast<std::size_t>(((index % kRows) + kRows) % kRows)];
  if (row.index != index || row.bore_radius_m != bore_radius_m) {
    row.index = index;
    row.bore_radius_m = bore_radius_m;
    Fill(row);
  }
  return row;
}

void FlowNoiseTable::Fill(Row& row) const {
  const WallFlow flow = CalcWallFlow(RowSpeed_m_s(row.index), row.bore_radius_m, water_);
  for (std::size_t k = 0; k < row.psd.size(); ++k) {
    const double f_Hz = static_cast<double>(k) * bin_width_Hz_;
    row.psd[k] = static_cast<float>(gain_[k] * CalcWallPressurePsd(flow, f_Hz) *
                                    CalcFaceAveraging(flow, face_radius_m_, f_Hz));
  }
}

}  // namespace piperun::acoustics
