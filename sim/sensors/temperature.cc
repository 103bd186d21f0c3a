#include "sim/output_register.h"
#include "sim/sensor.h"
#include "sim/thermal.h"

namespace piperun::sim::sensors::temperature {
namespace {

struct TemperatureParams : ParamsOf<TemperatureParams> {
  double rate_Hz = 1;
  ThermalParams thermal;
  double offset_K = 0;
  double offset_sd_K = 0;
  double noise_sd_K = 0;
  double resolution_K = 0;

  void Visit(ParamVisitor& v) override {
    v.Number({"rate_Hz", "Sampling rate."}, Range::Between(1e-3, 1e5), rate_Hz);
    v.Struct({"thermal", "How the sensor takes on the water's temperature."}, thermal);
    v.Number({"offset_K", "Constant offset."}, Range::Between(-100, 100), offset_K);
    v.Number({"offset_sd_K", "Offset: standard deviation, drawn once per run."}, Range::Between(0, 100),
             offset_sd_K);
    v.Number({"noise_sd_K", "White noise: standard deviation per sample."}, Range::Between(0, 100),
             noise_sd_K);
    v.Number({"resolution_K", "One count of the output register; 0 means unrounded."}, Range::NonNegative(),
             resolution_K);
  }
};

constexpr std::uint64_t kNoiseSlot = 0;
constexpr std::uint64_t kOffsetSlot = 1;

/// Temperature of the part of the ball that the sensor sits in: Q{ T(t) + offset + n }, T of sim/thermal.h
/// with t since release.
class TemperatureSensor final : public Sensor {
 public:
  TemperatureSensor(const TemperatureParams& p, const SensorContext& context)
      : params_(p),
        rate_(p.rate_Hz),
        offset_K_(p.offset_K + p.offset_sd_K * context.random.Normals(0, kOffsetSlot)[0]),
        context_(context) {
    output_.resolution = p.resolution_K;
  }

  Rate rate() const override { return rate_; }
  TrueTime DueTime(std::int64_t k) const override { return SampleTime(k, rate_); }
  /// Needs no truth but the time, however slowly it samples.
  Duration history() const override { return Duration(0); }
  Pose X_BS() const override { return {}; }

  SensorValue Sample(std::int64_t k, const TruthWindow&) override {
    const TrueTime due = DueTime(k);
    const double noise_K =
        params_.noise_sd_K * context_.random.Normals(static_cast<std::uint64_t>(k), kNoiseSlot)[0];
    const double truth_C = CalcTemperature_C(params_.thermal, context_.water_temperature_C, Seconds(due));
    return TemperatureSample{context_.clock.ToRobot(due), output_.Read(truth_C + offset_K_ + noise_K)};
  }

 private:
  TemperatureParams params_;
  Rate rate_;
  double offset_K_;
  SensorContext context_;
  OutputRegister output_;
};

std::unique_ptr<Sensor> Make(const Params& params, const SensorContext& context) {
  return std::make_unique<TemperatureSensor>(static_cast<const TemperatureParams&>(params), context);
}

}  // namespace

SensorKind Kind() {
  return {"temperature", "Temperature inside the ball, which follows the water's with a lag.", "temperature",
          MakeParams<TemperatureParams>, Make};
}

}  // namespace piperun::sim::sensors::temperature
