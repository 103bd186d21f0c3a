#include "base/check.h"
#include "base/number.h"
#include "sim/imu_error.h"
#include "sim/imu_interval.h"
#include "sim/sensor.h"

namespace piperun::sim::sensors::imu {
namespace {

struct ImuParams : ParamsOf<ImuParams> {
  double rate_Hz = 400;
  bool increments = false;
  Vector3d lever_arm_m = Vector3d::Zero();
  Vector3d mounting_rad = Vector3d::Zero();
  TriadErrorParams gyro;
  TriadErrorParams accel;

  void Visit(ParamVisitor& v) override {
    v.Number({"rate_Hz", "Sampling rate; at most the physics rate."}, Range::Between(0.1, 1e5), rate_Hz);
    v.Flag({"increments", "Also deliver the angle and velocity increments of every interval."}, increments);
    v.Vector({"lever_arm_m", "Where the sensor sits in the ball frame B (origin at the ball's centre)."},
             Range::Between(-1, 1), lever_arm_m);
    v.Vector({"mounting_rad", "Rotation vector of the sensor frame in B: q_BS = Exp(mounting_rad)."},
             Range::Between(-7, 7), mounting_rad);
    v.Group({"gyro", "Errors of the gyroscope."}, [this](ParamVisitor& g) { gyro.Visit(g, kGyroFields); });
    v.Group({"accel", "Errors of the accelerometer."},
            [this](ParamVisitor& a) { accel.Visit(a, kAccelFields); });
  }
};

/// One triad of the sensor: true mean over the interval in, reading out.
class Triad {
 public:
  Triad(const TriadErrorParams& params, Rate rate, const TriadStream& stream)
      : stream_(stream),
        coefficients_(MakeCoefficients(params, rate, stream)),
        state_(MakeState(coefficients_, stream)) {}

  Vector3d DrawError(std::int64_t k) { return StepError(state_, k, stream_, coefficients_); }
  Vector3d bias() const { return CalcBias(state_, coefficients_); }
  Vector3d Read(const Vector3d& truth, const Vector3d& error) const {
    return CalcReading(truth, error, coefficients_);
  }

 private:
  TriadStream stream_;
  TriadErrorCoefficients coefficients_;
  TriadErrorState state_;
};

class Imu final : public Sensor {
 public:
  Imu(const ImuParams& p, const SensorContext& context)
      : rate_(p.rate_Hz),
        increments_(p.increments),
        X_BS_{p.lever_arm_m, ExpSO3(p.mounting_rad)},
        R_SB_(X_BS_.q.conjugate().toRotationMatrix()),
        clock_(context.clock),
        gravity_W_(context.gravity_W),
        gyro_(p.gyro, rate_, {context.random, 0}),
        accel_(p.accel, rate_, {context.random, kTriadSlots}) {}

  Rate rate() const override { return rate_; }
  TrueTime DueTime(std::int64_t k) const override { return SampleTime(k + 1, rate_); }
  Pose X_BS() const override { return X_BS_; }
  std::optional<ImuBias> bias() const override { return ImuBias{gyro_.bias(), accel_.bias()}; }

  SensorValue Sample(std::int64_t k, const TruthWindow& window) override {
    Demand(k == next_++, "an IMU is sampled once per interval, in order");
    const TrueTime due = DueTime(k);
    const TrueTime begin = SampleTime(k, rate_);
    const ImuInterval truth = CalcImuInterval(window, begin, due, X_BS_.p);
    const Vector3d gyro_error = gyro_.DrawError(k);
    const Vector3d accel_error = accel_.DrawError(k);
    ImuSample sample;
    sample.stamp = clock_.ToRobot(due);
    sample.w_WS_S_rad_s = gyro_.Read(R_SB_ * truth.w_mean_rad_s, gyro_error);
    sample.f_WS_S_m_s2 = accel_.Read(R_SB_ * truth.f_mean_m_s2, accel_error);
    if (increments_) {
      const auto whole = CalcImuIncrements(window, begin, due, X_BS_.p, gravity_W_);
      const double T = whole.duration_s;
      sample.increments = ImuIncrements{T * gyro_.Read(R_SB_ * (whole.dtheta_rad / T), gyro_error),
                                        T * accel_.Read(R_SB_ * (whole.dv_m_s / T), accel_error)};
    }
    return sample;
  }

 private:
  Rate rate_;
  bool increments_;
  Pose X_BS_;
  Matrix3d R_SB_;
  ClockModel clock_;
  Vector3d gravity_W_;
  Triad gyro_;
  Triad accel_;
  std::int64_t next_ = 0;
};

std::unique_ptr<Sensor> Make(const Params& params, const SensorContext& context) {
  const auto& p = static_cast<const ImuParams&>(params);
  if (p.rate_Hz > context.truth_rate.Hz()) {
    throw InputError("an IMU cannot sample at " + FormatNumber(p.rate_Hz) +
                         " Hz faster than the motion's physics rate of " +
                         FormatNumber(context.truth_rate.Hz()) +
                         " Hz; lower it or raise the motion's rate_Hz",
                     "rate_Hz");
  }
  return std::make_unique<Imu>(p, context);
}

}  // namespace

SensorKind Kind() {
  return {"imu", "Gyroscope and accelerometer: means over the sampling interval, with their errors.", "imu",
          MakeParams<ImuParams>, Make};
}

}  // namespace piperun::sim::sensors::imu
