#include "sim/output_register.h"
#include "sim/sensor.h"

namespace piperun::sim::sensors::pressure {
namespace {

struct PressureParams : ParamsOf<PressureParams> {
  double rate_Hz = 50;
  double offset_Pa = 0;
  double offset_sd_Pa = 0;
  double noise_sd_Pa = 0;
  std::optional<double> range_Pa;
  double resolution_Pa = 0;

  void Visit(ParamVisitor& v) override {
    v.Number({"rate_Hz", "Sampling rate."}, Range::Between(0.1, 1e5), rate_Hz);
    v.Number({"offset_Pa", "Constant offset."}, Range::Any(), offset_Pa);
    v.Number({"offset_sd_Pa", "Offset: standard deviation, drawn once per run."}, Range::NonNegative(),
             offset_sd_Pa);
    v.Number({"noise_sd_Pa", "White noise: standard deviation per sample."}, Range::NonNegative(),
             noise_sd_Pa);
    v.NumberOr({"range_Pa", "The reading saturates at plus and minus this gauge pressure."},
               Range::Positive(), "none", range_Pa);
    v.Number({"resolution_Pa", "One count of the output register; 0 means unrounded."}, Range::NonNegative(),
             resolution_Pa);
  }
};

constexpr std::uint64_t kNoiseSlot = 0;
constexpr std::uint64_t kOffsetSlot = 1;

/// Gauge pressure at the ball's centre: Q{ clip{ p + offset + n } }.
class PressureSensor final : public Sensor {
 public:
  PressureSensor(const PressureParams& p, const SensorContext& context)
      : rate_(p.rate_Hz),
        offset_Pa_(p.offset_Pa + p.offset_sd_Pa * context.random.Normals(0, kOffsetSlot)[0]),
        noise_sd_Pa_(p.noise_sd_Pa),
        context_(context) {
    if (p.range_Pa) output_.range = *p.range_Pa;
    output_.resolution = p.resolution_Pa;
  }

  Rate rate() const override { return rate_; }
  TrueTime DueTime(std::int64_t k) const override { return SampleTime(k, rate_); }
  Pose X_BS() const override { return {}; }

  SensorValue Sample(std::int64_t k, const TruthWindow& window) override {
    const TrueTime due = DueTime(k);
    const double noise_Pa =
        noise_sd_Pa_ * context_.random.Normals(static_cast<std::uint64_t>(k), kNoiseSlot)[0];
    const double truth_Pa = Interpolate(window, due).pressure_Pa;
    return PressureSample{context_.clock.ToRobot(due), output_.Read(truth_Pa + offset_Pa_ + noise_Pa)};
  }

 private:
  Rate rate_;
  double offset_Pa_;
  double noise_sd_Pa_;
  SensorContext context_;
  OutputRegister output_;
};

std::unique_ptr<Sensor> Make(const Params& params, const SensorContext& context) {
  return std::make_unique<PressureSensor>(static_cast<const PressureParams&>(params), context);
}

}  // namespace

SensorKind Kind() {
  return {"pressure", "Gauge pressure at the ball's centre.", "pressure", MakeParams<PressureParams>, Make};
}

}  // namespace piperun::sim::sensors::pressure
