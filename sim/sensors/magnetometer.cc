#include "base/check.h"
#include "sim/imu_error.h"
#include "sim/output_register.h"
#include "sim/pipe_magnetism.h"
#include "sim/sensor.h"

namespace piperun::sim::sensors::magnetometer {
namespace {

struct MagnetometerParams : ParamsOf<MagnetometerParams> {
  double rate_Hz = 100;
  Vector3d field_W_T{2.6e-6, 25.1e-6, -40.4e-6};
  PipeMagnetismParams pipe;
  Vector3d mounting_rad = Vector3d::Zero();
  Vector3d hard_iron_T = Vector3d::Zero();
  Matrix3d soft_iron = Matrix3d::Identity();
  double bias_sd_T = 0;
  double scale_error_sd = 0;
  double misalignment_sd = 0;
  double noise_sd_T = 0;
  double bias_instability_T = 0;
  std::optional<double> range_T;
  double resolution_T = 0;

  void Visit(ParamVisitor& v) override {
    v.Number({"rate_Hz", "Sampling rate."}, Range::Between(0.1, 1e5), rate_Hz);
    v.Vector({"field_W_T", "Flux density in W (x east, y north, z up); default: central Anatolia, rounded."},
             Range::Between(-1, 1), field_W_T);
    v.Struct({"pipe", "What walls of iron and steel make of the field."}, pipe);
    v.Vector({"mounting_rad", "Rotation vector of the sensor frame in B: q_BS = Exp(mounting_rad)."},
             Range::Between(-7, 7), mounting_rad);
    v.Vector({"hard_iron_T", "Offset from magnetised parts fixed in the ball, in S."}, Range::Between(-1, 1),
             hard_iron_T);
    v.Matrix({"soft_iron", "Soft-iron, scale and misalignment matrix, row by row; identity when perfect."},
             Range::Between(-10, 10), soft_iron);
    VisitErrors(v);
    v.NumberOr({"range_T", "The reading saturates at plus and minus this value."}, Range::Positive(), "none",
               range_T);
    v.Number({"resolution_T", "One count of the output register; 0 means unrounded."}, Range::NonNegative(),
             resolution_T);
  }

  /// The errors that run and drift, as three axes of an inertial sensor have them; white noise is drawn here.
  TriadErrorParams MakeErrors() const {
    TriadErrorParams errors;
    errors.bias_sd = bias_sd_T;
    errors.scale_error_sd = scale_error_sd;
    errors.misalignment_sd = misalignment_sd;
    errors.bias_instability = bias_instability_T;
    errors.range = range_T;
    errors.resolution = resolution_T;
    return errors;
  }

 private:
  void VisitErrors(ParamVisitor& v) {
    v.Number({"bias_sd_T", "Bias: standard deviation, drawn once per axis and run."}, Range::NonNegative(),
             bias_sd_T);
    v.Number({"scale_error_sd", "Scale-factor error: standard deviation, drawn once per axis and run."},
             Range::Between(0, 1), scale_error_sd);
    v.Number({"misalignment_sd", "Misalignment: standard deviation per off-diagonal element and run."},
             Range::Between(0, 1), misalignment_sd);
    v.Number({"noise_sd_T", "White noise: standard deviation per axis and sample."}, Range::NonNegative(),
             noise_sd_T);
    v.Number({"bias_instability_T", "Bias instability B; the floor of the Allan deviation is 0.664 B."},
             Range::NonNegative(), bias_instability_T);
  }
};

constexpr std::uint64_t kNoiseSlot = 0;
constexpr std::uint64_t kErrorSlot = 64;

/// m_S = Q{ clip{ (I + s + M) (A R_SW m_W + h) + b + n } }: field m_W where the ball is, soft iron A, hard
/// iron h, errors of the axes s and M, bias and its drift b, white noise n.
class Magnetometer final : public Sensor {
 public:
  Magnetometer(const MagnetometerParams& p, const SensorContext& context)
      : params_(p),
        rate_(p.rate_Hz),
        q_BS_(ExpSO3(p.mounting_rad)),
        context_(context),
        pipe_(MakePipe(p.pipe, context)),
        stream_{context.random, kErrorSlot},
        errors_(MakeCoefficients(p.MakeErrors(), rate_, stream_)),
        drift_(MakeState(errors_, stream_)) {}

  Rate rate() const override { return rate_; }
  TrueTime DueTime(std::int64_t k) const override { return SampleTime(k, rate_); }
  Pose X_BS() const override { return {Vector3d::Zero(), q_BS_}; }

  SensorValue Sample(std::int64_t k, const TruthWindow& window) override {
    const TrueTime due = DueTime(k);
    const TruthState truth = Interpolate(window, due);
    const Quaterniond q_WS = truth.X_WB.q * q_BS_;
    const auto n = context_.random.Normals(static_cast<std::uint64_t>(k), kNoiseSlot);
    StepDrift(drift_, k, stream_, errors_);
    const Vector3d m_S = params_.soft_iron * (q_WS.conjugate() * CalcField_W_T(truth)) + params_.hard_iron_T;
    const Vector3d error_S = CalcBias(drift_, errors_) + params_.noise_sd_T * Vector3d(n[0], n[1], n[2]);
    return MagSample{context_.clock.ToRobot(due), CalcReading(m_S, error_S, errors_)};
  }

 private:
  static PipeMagnetism MakePipe(const PipeMagnetismParams& params, const SensorContext& context) {
    try {
      return PipeMagnetism(params, {context.network, context.joints, context.seed, context.run});
    } catch (const InputError& e) {
      throw InputError(e.problem(), "pipe." + e.key_path());
    }
  }

  Vector3d CalcField_W_T(const TruthState& truth) const {
    if (!pipe_.any() || truth.pipe < 0) return params_.field_W_T;
    const Vector3d axis_W = context_.network->pipe(truth.pipe).Eval(truth.s_m).tangent_W;
    return pipe_.CalcField_W_T(params_.field_W_T, truth.pipe, truth.s_m, axis_W);
  }

  MagnetometerParams params_;
  Rate rate_;
  Quaterniond q_BS_;
  SensorContext context_;
  PipeMagnetism pipe_;
  TriadStream stream_;
  TriadErrorCoefficients errors_;
  TriadErrorState drift_;
};

std::unique_ptr<Sensor> Make(const Params& params, const SensorContext& context) {
  return std::make_unique<Magnetometer>(static_cast<const MagnetometerParams&>(params), context);
}

}  // namespace

SensorKind Kind() {
  return {"magnetometer", "Three-axis magnetometer in the ball's pipe, with hard and soft iron and errors.",
          "magnetometer", MakeParams<MagnetometerParams>, Make};
}

}  // namespace piperun::sim::sensors::magnetometer
