#include "scenarios/replay.h"

#include <array>
#include <climits>
#include <cmath>
#include <vector>

#include "acoustics/audio_file.h"
#include "base/check.h"
#include "scenarios/csv_headers.h"
#include "scenarios/csv_reader.h"
#include "scenarios/measurement_writer.h"
#include "scenarios/yaml_document.h"

namespace piperun::scenarios {
namespace {

namespace fs = std::filesystem;

/// One channel's record, one measurement ahead.
class ChannelLog {
 public:
  explicit ChannelLog(int channel) { measurement_.channel = channel; }
  virtual ~ChannelLog() = default;
  const Measurement& current() const { return measurement_; }
  virtual bool may_be_empty() const { return false; }
  bool Advance() {
    const RobotTime before = Stamp(measurement_);
    if (!Read()) return false;
    if (started_ && Stamp(measurement_) < before) throw InputError("time goes backwards", "", Name());
    started_ = true;
    return true;
  }

 protected:
  virtual bool Read() = 0;
  virtual std::string Name() const = 0;
  Measurement measurement_;

 private:
  bool started_ = false;
};

RobotTime ToStamp(std::int64_t ns) { return RobotTime(Duration(ns)); }

class CsvLog : public ChannelLog {
 public:
  CsvLog(int channel, const fs::path& folder, std::string_view header, StampOrder order = StampOrder::kRise)
      : ChannelLog(channel), path_(folder / "data.csv"), data_(path_, header, order) {}

 protected:
  std::string Name() const override { return path_.string(); }
  fs::path path_;
  CsvReader data_;
};

/// The rows of flags.csv, one ahead. Most samples have none.
class FlagsLog {
 public:
  explicit FlagsLog(const fs::path& path) : path_(path), reader_(path, kFlagsHeader) { Advance(); }

  /// Those of the sample with this stamp. Stamps rise.
  ImuFlags At(std::int64_t stamp) {
    if (!more_ || stamp_ > stamp) return {};
    if (stamp_ < stamp) Refuse("this stamp is not in data.csv");
    const ImuFlags flags = flags_;
    Advance();
    return flags;
  }
  void End() const {
    if (more_) Refuse("this stamp is not in data.csv");
  }

 private:
  void Advance() {
    std::array<double, 2> v{};
    more_ = reader_.Next(stamp_, v);
    if (!more_) return;
    const bool known = v[0] >= 0 && v[0] < 64 && v[0] == std::floor(v[0]) && (v[1] == 0 || v[1] == 1);
    if (!known) Refuse("flags are: saturated 0 to 63, duplicated 0 or 1");
    flags_ = {static_cast<std::uint8_t>(v[0]), v[1] == 1};
  }
  [[noreturn]] void Refuse(const std::string& problem) const {
    throw InputError(problem, "", path_.string() + ", stamp " + std::to_string(stamp_));
  }

  fs::path path_;
  CsvReader reader_;
  bool more_ = false;
  std::int64_t stamp_ = 0;
  ImuFlags flags_;
};

class ImuLog : public CsvLog {
 public:
  ImuLog(int channel, const fs::path& folder) : CsvLog(channel, folder, kImuHeader) {
    const fs::path increments = folder / "increments.csv", flags = folder / "flags.csv";
    if (fs::exists(increments)) increments_ = std::make_unique<CsvReader>(increments, kIncrementsHeader);
    if (fs::exists(flags)) flags_ = std::make_unique<FlagsLog>(flags);
  }

 protected:
  bool Read() override {
    std::array<double, 6> v{};
    std::int64_t stamp = 0;
    if (!data_.Next(stamp, v)) {
      if (flags_) flags_->End();
      return false;
    }
    ImuSample sample{ToStamp(stamp), {v[0], v[1], v[2]}, {v[3], v[4], v[5]}, std::nullopt};
    if (increments_) sample.increments = ReadIncrements(stamp);
    if (flags_) sample.flags = flags_->At(stamp);
    measurement_.value = sample;
    return true;
  }

 private:
  ImuIncrements ReadIncrements(std::int64_t stamp) {
    std::array<double, 6> v{};
    std::int64_t increment_stamp = 0;
    if (!increments_->Next(increment_stamp, v) || increment_stamp != stamp) {
      throw InputError("increments.csv and data.csv do not have the same stamps", "", Name());
    }
    return {{v[0], v[1], v[2]}, {v[3], v[4], v[5]}};
  }

  std::unique_ptr<CsvReader> increments_;
  std::unique_ptr<FlagsLog> flags_;
};

class MagLog : public CsvLog {
 public:
  MagLog(int channel, const fs::path& folder) : CsvLog(channel, folder, kMagHeader) {}

 protected:
  bool Read() override {
    std::array<double, 3> v{};
    std::int64_t stamp = 0;
    if (!data_.Next(stamp, v)) return false;
    measurement_.value = MagSample{ToStamp(stamp), {v[0], v[1], v[2]}};
    return true;
  }
};

class PressureLog : public CsvLog {
 public:
  PressureLog(int channel, const fs::path& folder) : CsvLog(channel, folder, kPressureHeader) {}

 protected:
  bool Read() override {
    std::array<double, 1> v{};
    std::int64_t stamp = 0;
    if (!data_.Next(stamp, v)) return false;
    measurement_.value = PressureSample{ToStamp(stamp), v[0]};
    return true;
  }
};

class TemperatureLog : public CsvLog {
 public:
  TemperatureLog(int channel, const fs::path& folder) : CsvLog(channel, folder, kTemperatureHeader) {}

 protected:
  bool Read() override {
    std::array<double, 1> v{};
    std::int64_t stamp = 0;
    if (!data_.Next(stamp, v)) return false;
    measurement_.value = TemperatureSample{ToStamp(stamp), v[0]};
    return true;
  }
};

class MarkerLog : public CsvLog {
 public:
  /// Two receivers may log one instant.
  MarkerLog(int channel, const fs::path& folder)
      : CsvLog(channel, folder, kMarkerHeader, StampOrder::kDoNotFall) {}
  /// No ball may have come by.
  bool may_be_empty() const override { return true; }

 protected:
  bool Read() override {
    std::array<double, 4> v{};
    std::int64_t stamp = 0;
    if (!data_.Next(stamp, v)) return false;
    const bool known = v[0] >= 0 && v[0] <= INT_MAX && v[0] == std::floor(v[0]);
    if (!known) data_.Refuse("a receiver is a whole number from 0 on");
    measurement_.value = MarkerPass{ToStamp(stamp), static_cast<int>(v[0]), {v[1], v[2], v[3]}};
    return true;
  }
};

AudioDescription LoadDescription(const fs::path& folder) {
  const fs::path path = folder / "sensor.yaml";
  AudioDescription description;
  YamlDocument::FromFile(path.string()).ReadSome([&](ParamVisitor& v) { description.Visit(v); });
  return description;
}

class AudioLog : public ChannelLog {
 public:
  AudioLog(int channel, const fs::path& folder)
      : ChannelLog(channel),
        description_(LoadDescription(folder)),
        path_(folder / description_.file),
        reader_(path_, description_.bits),
        counts_(static_cast<std::size_t>(description_.block_samples)) {
    const acoustics::AudioFormat& format = reader_.format();
    if (static_cast<double>(format.rate_Hz) != description_.rate_Hz || format.bits != description_.bits) {
      throw InputError("rate or bits are not those of its sensor.yaml", "", Name());
    }
    if (reader_.frames() % description_.block_samples != 0) {
      throw InputError("the record does not end with a whole block; it has been cut short", "", Name());
    }
  }

 protected:
  std::string Name() const override { return path_.string(); }
  bool Read() override {
    if (reader_.Read(counts_) < counts_.size()) return false;
    next_sample_ += description_.block_samples;
    measurement_.value = AudioBlock{
        ToStamp(description_.start_ns) + SampleOffset(next_sample_ - 1, Rate(description_.rate_Hz)),
        description_.rate_Hz, description_.scale_Pa, counts_};
    return true;
  }

 private:
  AudioDescription description_;
  fs::path path_;
  acoustics::AudioReader reader_;
  std::vector<std::int32_t> counts_;
  std::int64_t next_sample_ = 0;
};

std::unique_ptr<ChannelLog> OpenLog(int channel, const RecordedChannel& recorded, const fs::path& folder) {
  if (recorded.type == "imu") return std::make_unique<ImuLog>(channel, folder);
  if (recorded.type == "magnetometer") return std::make_unique<MagLog>(channel, folder);
  if (recorded.type == "pressure") return std::make_unique<PressureLog>(channel, folder);
  if (recorded.type == "marker") return std::make_unique<MarkerLog>(channel, folder);
  if (recorded.type == "temperature") return std::make_unique<TemperatureLog>(channel, folder);
  return std::make_unique<AudioLog>(channel, folder);
}

bool ComesBefore(const Measurement& a, const Measurement& b) {
  if (IsReadOutLater(a) != IsReadOutLater(b)) return IsReadOutLater(b);
  return Stamp(a) < Stamp(b);
}

}  // namespace

struct MeasurementLog::Impl {
  std::vector<std::unique_ptr<ChannelLog>> open;  // in channel order
  ChannelLog* delivered = nullptr;

  void Drop(const ChannelLog* log) {
    std::erase_if(open, [log](const auto& entry) { return entry.get() == log; });
  }
};

MeasurementLog::MeasurementLog(const fs::path& run_folder, const EstimatorInput& input)
    : impl_(std::make_unique<Impl>()) {
  for (std::size_t i = 0; i < input.channels.size(); ++i) {
    auto log = OpenLog(static_cast<int>(i), input.channels[i], run_folder / "mav0" / input.channels[i].name);
    if (log->Advance()) {
      impl_->open.push_back(std::move(log));
    } else if (!log->may_be_empty()) {
      throw InputError("the record is empty", "", "mav0/" + input.channels[i].name);
    }
  }
}

MeasurementLog::~MeasurementLog() = default;

const Measurement* MeasurementLog::Next() {
  if (impl_->delivered && !impl_->delivered->Advance()) impl_->Drop(impl_->delivered);
  impl_->delivered = nullptr;
  for (const auto& log : impl_->open) {
    if (!impl_->delivered || ComesBefore(log->current(), impl_->delivered->current()))
      impl_->delivered = log.get();
  }
  return impl_->delivered ? &impl_->delivered->current() : nullptr;
}

}  // namespace piperun::scenarios
