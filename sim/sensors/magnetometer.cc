#include "sim/output_register.h"
#include "sim/sensor.h"

namespace piperun::sim::sensors::magnetometer {
namespace {

struct MagnetometerParams : ParamsOf<MagnetometerParams> {
  double rate_Hz = 100;
  Vector3d field_W_T{2.6e-6, 25.1e-6, -40.4e-6};
  Vector3d mounting_rad = Vector3d::Zero();
  Vector3d hard_iron_T = Vector3d::Zero();
  Matrix3d soft_iron = Matrix3d::Identity();
  double noise_sd_T = 0;
  std::optional<double> range_T;
  double resolution_T = 0;

  void Visit(ParamVisitor& v) override {
    v.Number({"rate_Hz", "Sampling rate."}, Range::Between(0.1, 1e5), rate_Hz);
    v.Vector({"field_W_T", "Flux density in W (x east, y north, z up); default: central Anatolia, rounded."},
             Range::Between(-1, 1), field_W_T);
    v.Vector({"mounting_rad", "Rotation vector of the sensor frame in B: q_BS = Exp(mounting_rad)."},
             Range::Between(-7, 7), mounting_rad);
    v.Vector({"hard_iron_T", "Offset from magnetised parts fixed in the ball, in S."}, Range::Between(-1, 1),
             hard_iron_T);
    v.Matrix({"soft_iron", "Soft-iron, scale and misalignment matrix, row by row; identity when perfect."},
             Range::Between(-10, 10), soft_iron);
    v.Number({"noise_sd_T", "White noise: standard deviation per axis and sample."}, Range::NonNegative(),
             noise_sd_T);
    v.NumberOr({"range_T", "The reading saturates at plus and minus this value."}, Range::Positive(), "none",
               range_T);
    v.Number({"resolution_T", "One count of the output register; 0 means unrounded."}, Range::NonNegative(),
             resolution_T);
  }
};

/// m_S = Q{ clip{ A R_SW m_W + h + n } }: field m_W uniform, soft iron A, hard iron h, white noise n.
class Magnetometer final : public Sensor {
 public:
  Magnetometer(const MagnetometerParams& p, const SensorContext& context)
      : params_(p), rate_(p.rate_Hz), q_BS_(ExpSO3(p.mounting_rad)), context_(context) {
    if (p.range_T) output_.range = *p.range_T;
    output_.resolution = p.resolution_T;
  }

  Rate rate() const override { return rate_; }
  TrueTime DueTime(std::int64_t k) const override { return SampleTime(k, rate_); }
  Pose X_BS() const override { return {Vector3d::Zero(), q_BS_}; }

  SensorValue Sample(std::int64_t k, const TruthWindow& window) override {
    const TrueTime due = DueTime(k);
    const Quaterniond q_WS = Interpolate(window, due).X_WB.q * q_BS_;
    const auto n = context_.random.Normals(static_cast<std::uint64_t>(k), 0);
    const Vector3d m_S = params_.soft_iron * (q_WS.conjugate() * params_.field_W_T) + params_.hard_iron_T +
                         params_.noise_sd_T * Vector3d(n[0], n[1], n[2]);
    return MagSample{context_.clock.ToRobot(due), output_.Read(m_S)};
  }

 private:
  MagnetometerParams params_;
  Rate rate_;
  Quaterniond q_BS_;
  SensorContext context_;
  OutputRegister output_;
};

std::unique_ptr<Sensor> Make(const Params& params, const SensorContext& context) {
  return std::make_unique<Magnetometer>(static_cast<const MagnetometerParams&>(params), context);
}

}  // namespace

SensorKind Kind() {
  return {"magnetometer", "Three-axis magnetometer in a uniform field, with hard and soft iron.",
          "magnetometer", MakeParams<MagnetometerParams>, Make};
}

}  // namespace piperun::sim::sensors::magnetometer
