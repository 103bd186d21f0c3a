#include "scenarios/measurement_writer.h"

#include <cmath>

#include "acoustics/audio_file.h"
#include "acoustics/hydrophone.h"
#include "base/check.h"
#include "scenarios/csv_headers.h"
#include "scenarios/csv_row.h"

namespace piperun::scenarios {
namespace {

std::int64_t Nanoseconds(RobotTime t) { return t.time_since_epoch().count(); }

/// sensor.yaml in EuRoC's layout, with our parameters behind it.
void WriteSensorYaml(const std::filesystem::path& folder, const SensorEntry& entry, const Pose& X_BS,
                     const VisitFunction& more) {
  KindEntry kind = entry.kind;
  std::string type = entry.kind.kind();
  Eigen::Matrix<double, 4, 4, Eigen::RowMajor> T_BS = Eigen::Matrix4d::Identity();
  T_BS.topLeftCorner<3, 3>() = X_BS.q.toRotationMatrix();
  T_BS.topRightCorner<3, 1>() = X_BS.p;
  std::int64_t four = 4;
  WriteTextFile(folder / "sensor.yaml", WriteYaml([&](ParamVisitor& v) {
                  v.Text({"sensor_type", ""}, type);
                  v.Group({"T_BS", ""}, [&](ParamVisitor& t) {
                    t.Integer({"cols", ""}, 4, 4, four);
                    t.Integer({"rows", ""}, 4, 4, four);
                    t.Array({"data", ""}, Range::Any(), std::span<double>(T_BS.data(), 16));
                  });
                  more(v);
                  v.Struct({"params", ""}, kind);
                }));
}

/// Channels that go into CSV files.
class CsvWriter : public MeasurementWriter {
 public:
  CsvWriter(const SensorEntry& entry, const Pose& X_BS, const std::filesystem::path& folder,
            std::string_view header)
      : folder_(folder), data_(folder / "data.csv") {
    data_.Append(header);
    WriteSensorYaml(folder, entry, X_BS, [](ParamVisitor&) {});
  }
  void Close() override { data_.Close(); }

 protected:
  std::filesystem::path folder_;
  OutputFile data_;
};

class ImuWriter : public CsvWriter {
 public:
  ImuWriter(const SensorEntry& entry, const Pose& X_BS, const std::filesystem::path& folder)
      : CsvWriter(entry, X_BS, folder, kImuHeader) {}
  void Write(const Measurement& measurement) override {
    const auto& sample = std::get<ImuSample>(measurement.value);
    CsvRow(data_) << Nanoseconds(sample.stamp) << sample.w_WS_S_rad_s << sample.f_WS_S_m_s2 << kEndOfRow;
    if (sample.flags.any()) {
      CsvRow(Open(flags_, "flags.csv", kFlagsHeader))
          << Nanoseconds(sample.stamp) << std::int64_t{sample.flags.saturated}
          << std::int64_t{sample.flags.duplicated} << kEndOfRow;
    }
    if (sample.increments) {
      CsvRow(Open(increments_, "increments.csv", kIncrementsHeader))
          << Nanoseconds(sample.stamp) << sample.increments->dtheta_S_rad << sample.increments->dv_S_m_s
          << kEndOfRow;
    }
  }
  void Close() override {
    CsvWriter::Close();
    if (increments_) increments_->Close();
    if (flags_) flags_->Close();
  }

 private:
  /// A file that only exists when there is something to write into it.
  OutputFile& Open(std::unique_ptr<OutputFile>& file, const char* name, std::string_view header) {
    if (!file) {
      file = std::make_unique<OutputFile>(folder_ / name);
      file->Append(header);
    }
    return *file;
  }

  std::unique_ptr<OutputFile> increments_;
  std::unique_ptr<OutputFile> flags_;
};

class MagWriter : public CsvWriter {
 public:
  MagWriter(const SensorEntry& entry, const Pose& X_BS, const std::filesystem::path& folder)
      : CsvWriter(entry, X_BS, folder, kMagHeader) {}
  void Write(const Measurement& measurement) override {
    const auto& sample = std::get<MagSample>(measurement.value);
    CsvRow(data_) << Nanoseconds(sample.stamp) << sample.m_S_T << kEndOfRow;
  }
};

class PressureWriter : public CsvWriter {
 public:
  PressureWriter(const SensorEntry& entry, const Pose& X_BS, const std::filesystem::path& folder)
      : CsvWriter(entry, X_BS, folder, kPressureHeader) {}
  void Write(const Measurement& measurement) override {
    const auto& sample = std::get<PressureSample>(measurement.value);
    CsvRow(data_) << Nanoseconds(sample.stamp) << sample.pressure_Pa << kEndOfRow;
  }
};

class TemperatureWriter : public CsvWriter {
 public:
  TemperatureWriter(const SensorEntry& entry, const Pose& X_BS, const std::filesystem::path& folder)
      : CsvWriter(entry, X_BS, folder, kTemperatureHeader) {}
  void Write(const Measurement& measurement) override {
    const auto& sample = std::get<TemperatureSample>(measurement.value);
    CsvRow(data_) << Nanoseconds(sample.stamp) << sample.temperature_C << kEndOfRow;
  }
};

class MarkerWriter : public CsvWriter {
 public:
  MarkerWriter(const SensorEntry& entry, const Pose& X_BS, const std::filesystem::path& folder)
      : CsvWriter(entry, X_BS, folder, kMarkerHeader) {}
  void Write(const Measurement& measurement) override {
    const auto& pass = std::get<MarkerPass>(measurement.value);
    CsvRow(data_) << Nanoseconds(pass.stamp) << std::int64_t{pass.receiver} << pass.p_W << kEndOfRow;
  }
};

AudioDescription Describe(const acoustics::HydrophoneParams& params, const RecordOptions& options) {
  AudioDescription d;
  d.file = options.audio_format == "flac" ? "audio.flac" : "audio.wav";
  d.rate_Hz = params.rate_Hz;
  d.block_samples = params.block_samples;
  d.bits = params.bits;
  d.full_scale_Pa = params.full_scale_Pa;
  d.scale_Pa = params.scale_Pa();
  d.start_ns = Nanoseconds(options.start);
  return d;
}

acoustics::AudioFormat MakeFormat(const acoustics::HydrophoneParams& params, const RecordOptions& options) {
  using acoustics::AudioContainer;
  const AudioContainer container = options.audio_format == "flac"        ? AudioContainer::kFlac
                                   : options.audio_format == "wav_float" ? AudioContainer::kFloatWav
                                                                         : AudioContainer::kWav;
  return {container, std::llround(params.rate_Hz), params.bits};
}

class AudioChannelWriter : public MeasurementWriter {
 public:
  AudioChannelWriter(const SensorEntry& entry, const acoustics::HydrophoneParams& params,
                     const RecordOptions& options, const std::filesystem::path& folder)
      : entry_(entry),
        folder_(folder),
        description_(Describe(params, options)),
        largest_code_((std::int32_t{1} << (params.bits - 1)) - 1),
        file_(folder / description_.file, MakeFormat(params, options),
              static_cast<std::int64_t>(std::ceil(options.longest_s * params.rate_Hz))) {}
  void Write(const Measurement& measurement) override {
    const auto& block = std::get<AudioBlock>(measurement.value);
    file_.Write(block.counts);
    for (const std::int32_t count : block.counts)
      description_.clipped_samples += std::abs(count) >= largest_code_;
  }
  void CountDropped(std::int64_t samples) override { description_.dropped_samples = samples; }
  void Close() override {
    file_.Close();
    WriteSensorYaml(folder_, entry_, Pose{}, [this](ParamVisitor& v) { description_.Visit(v); });
  }

 private:
  SensorEntry entry_;
  std::filesystem::path folder_;
  AudioDescription description_;
  std::int32_t largest_code_;
  acoustics::AudioWriter file_;
};

}  // namespace

void AudioDescription::Visit(ParamVisitor& v) {
  v.Text({"file", "The record, one channel.", true}, file);
  v.Number({"rate_Hz", "Samples per second of the robot's clock.", true}, Range::Between(1, 1e6), rate_Hz);
  v.Integer({"block_samples", "Samples in one delivered block.", true}, 1, INT32_MAX, block_samples);
  v.Integer({"bits", "Bits of the converter.", true}, 8, 32, bits);
  v.Number({"full_scale_Pa", "Pressure of the largest code.", true}, Range::Positive(), full_scale_Pa);
  v.Number({"scale_Pa", "Pressure of one count.", true}, Range::Positive(), scale_Pa);
  v.Integer({"start_ns", "Stamp of sample 0.", true}, INT64_MIN, INT64_MAX, start_ns);
  v.Integer({"clipped_samples", "Samples at the end of the scale.", true}, 0, INT64_MAX, clipped_samples);
  v.Integer({"dropped_samples", "Zeros that stand for samples lost in drop-outs."}, 0, INT64_MAX,
            dropped_samples);
}

std::unique_ptr<MeasurementWriter> MakeMeasurementWriter(const SensorEntry& entry, const Pose& X_BS,
                                                         const RecordOptions& options,
                                                         const std::filesystem::path& folder) {
  const std::string_view records = entry.kind.records();
  if (records == "imu") return std::make_unique<ImuWriter>(entry, X_BS, folder);
  if (records == "magnetometer") return std::make_unique<MagWriter>(entry, X_BS, folder);
  if (records == "pressure") return std::make_unique<PressureWriter>(entry, X_BS, folder);
  if (records == "temperature") return std::make_unique<TemperatureWriter>(entry, X_BS, folder);
  if (records == "marker") return std::make_unique<MarkerWriter>(entry, X_BS, folder);
  Demand(records == "audio", "every sensor kind records something that can be written");
  const auto& params = dynamic_cast<const acoustics::HydrophoneParams&>(entry.kind.params());
  return std::make_unique<AudioChannelWriter>(entry, params, options, folder);
}

}  // namespace piperun::scenarios
