#include "base/check.h"
#include "sim/imu_interval.h"
#include "sim/imu_params.h"
#include "sim/imu_steps.h"
#include "sim/imu_strapdown.h"
#include "sim/imu_triad.h"
#include "sim/sensor.h"

namespace piperun::sim::sensors::imu {
namespace {

constexpr std::uint64_t kMountingSlot = 66;  // beyond those of triads and sampling

Quaterniond MakeTrueMounting(const ImuParams& p, const RandomStream& random) {
  const auto n = random.SixNormals(0, kMountingSlot);
  const Vector3d error = p.mounting_error_rad + p.mounting_error_sd_rad * Vector3d(n[0], n[1], n[2]);
  const Quaterniond nominal = ExpSO3(p.mounting_rad);
  return error.isZero(0) ? nominal : nominal * ExpSO3(error);
}

/// Samples are formed in one of three ways. From the means of a whole interval, where everything in front of
/// the samples is linear and memoryless. From the state at the interval's end, for point output. Physics step
/// by physics step, where filters or curvature stand in front of the samples; point output is then the last
/// whole step's.
class Imu final : public Sensor {
 public:
  Imu(const ImuParams& p, const SensorContext& context)
      : params_(p),
        plan_(p.sampling, Rate(p.rate_Hz), context.random),
        X_BS_{p.lever_arm_m, ExpSO3(p.mounting_rad)},
        R_SB_(MakeTrueMounting(p, context.random).conjugate().toRotationMatrix()),
        point_(p.point()),
        has_size_effect_(!p.accel_positions_m.isZero(0)),
        context_(context),
        gyro_(TriadType::kGyroscope, p.gyro, plan_.rate(), context.truth_rate, {context.random, 0}),
        accel_(TriadType::kAccelerometer, p.accel, plan_.rate(), context.truth_rate,
               {context.random, kTriadSlots}),
        by_steps_(gyro_.needs_steps() || accel_.needs_steps() ||
                  (has_size_effect_ && p.increments && p.coning_sculling)) {}

  Rate rate() const override { return plan_.rate(); }
  TrueTime DueTime(std::int64_t k) const override { return plan_.DueTimeOf(k); }
  Duration history() const override { return SampleOffset(1, rate()) + 2 * plan_.Scatter(); }
  Duration lookahead() const override { return 2 * plan_.Scatter(); }
  Pose X_BS() const override { return X_BS_; }
  std::optional<ImuBias> bias() const override { return ImuBias{gyro_.bias(), accel_.bias()}; }

  SensorValue Sample(std::int64_t k, const TruthWindow& window) override {
    Demand(k == next_++, "an IMU is sampled once per interval, in order");
    const Interval interval{plan_.InstantOf(k - 1), plan_.InstantOf(k)};
    BeginSample(k, interval.end);
    ImuSample sample;
    sample.stamp = context_.clock.ToRobot(DueTime(k));
    if (by_steps_) {
      MeasureSteps(window, interval, sample);
    } else if (point_) {
      MeasureInstant(window, interval.end, sample);
    } else {
      MeasureMeans(window, interval, sample);
    }
    HoldStuckAxes(interval, sample);
    return Deliver(k, sample);
  }

 private:
  struct Interval {
    TrueTime begin;
    TrueTime end;
  };

  /// Axes that met their range, three bits each.
  struct Saturated {
    unsigned gyro = 0;
    unsigned accel = 0;
    std::uint8_t bits() const { return static_cast<std::uint8_t>(gyro | accel << 3); }
  };

  double CalcWarming_K(TrueTime t) const {
    if (!gyro_.feels_temperature() && !accel_.feels_temperature()) return 0;
    return CalcTemperature_C(params_.thermal, context_.water_temperature_C, Seconds(t)) - params_.reference_C;
  }

  void BeginSample(std::int64_t k, TrueTime end) {
    const double warming_K = CalcWarming_K(end);
    gyro_.BeginSample(k, warming_K);
    accel_.BeginSample(k, warming_K);
  }

  /// What the accelerometers feel beyond the sensor's origin: row i of A_S times the place of accelerometer
  /// i.
  Vector3d CalcSizeEffect(const Matrix3d& lever_B_1_s2) const {
    const Matrix3d lever_S = R_SB_ * lever_B_1_s2 * R_SB_.transpose();
    return lever_S.cwiseProduct(params_.accel_positions_m).rowwise().sum();
  }

  void MeasureMeans(const TruthWindow& window, const Interval& interval, ImuSample& sample) {
    const ImuInterval truth = CalcImuInterval(window, interval.begin, interval.end, X_BS_.p);
    const Vector3d w = R_SB_ * truth.w_mean_rad_s;
    Vector3d f = R_SB_ * truth.f_mean_m_s2;
    if (has_size_effect_) f += CalcSizeEffect(CalcMeanLeverTensor(window, interval.begin, interval.end));
    Saturated saturated;
    sample.w_WS_S_rad_s = gyro_.Read(w, f, saturated.gyro);
    sample.f_WS_S_m_s2 = accel_.Read(f, f, saturated.accel);
    if (params_.increments && params_.coning_sculling) {
      const auto whole = CalcImuIncrements(window, interval.begin, interval.end, X_BS_.p, context_.gravity_W);
      const double T = whole.duration_s;
      const Vector3d dv = R_SB_ * (whole.dv_m_s / T);
      sample.increments = ImuIncrements{T * gyro_.Read(R_SB_ * (whole.dtheta_rad / T), f, saturated.gyro),
                                        T * accel_.Read(dv, f, saturated.accel)};
    } else if (params_.increments) {
      sample.increments = Sums(truth.duration_s, sample);
    }
    sample.flags.saturated = saturated.bits();
  }

  static ImuIncrements Sums(double duration_s, const ImuSample& sample) {
    return {duration_s * sample.w_WS_S_rad_s, duration_s * sample.f_WS_S_m_s2};
  }

  void MeasureInstant(const TruthWindow& window, TrueTime t, ImuSample& sample) {
    const ImuSignal truth = CalcImuInstant(window, t, X_BS_.p);
    const Vector3d f = R_SB_ * truth.f_m_s2 + CalcSizeEffect(truth.lever_1_s2);
    Saturated saturated;
    sample.w_WS_S_rad_s = gyro_.Read(R_SB_ * truth.w_rad_s, f, saturated.gyro);
    sample.f_WS_S_m_s2 = accel_.Read(f, f, saturated.accel);
    sample.flags.saturated = saturated.bits();
  }

  /// Both front ends through the step from a to b.
  void StepFrontEnds(const TruthState& a, const TruthState& b, std::int64_t n, Saturated& saturated) {
    const double dt_s = context_.truth_rate.Period_s();
    const ImuSignal truth = CalcImuStep(a, b, X_BS_.p, dt_s);
    const Vector3d f = R_SB_ * truth.f_m_s2 + CalcSizeEffect(truth.lever_1_s2);
    step_.w = gyro_.StepFrontEnd(n, R_SB_ * truth.w_rad_s, f, saturated.gyro);
    step_.f = accel_.StepFrontEnd(n, f, f, saturated.accel);
    if (params_.increments) strapdown_.Next(dt_s * step_.w, dt_s * step_.f);
    step_.n = n;
  }

  void MeasureSteps(const TruthWindow& window, const Interval& interval, ImuSample& sample) {
    Saturated saturated;
    double steps = 0;
    Vector3d w = Vector3d::Zero(), f = Vector3d::Zero();
    strapdown_.Begin();
    const auto visit = [&](const TruthState& a, const TruthState& b, double from, double to, std::int64_t n) {
      const double part = to - from;
      if (point_ && to < 1) return;
      if (n > step_.n) StepFrontEnds(a, b, n, saturated);
      steps += part;
      w += part * step_.w;
      f += part * step_.f;
      if (params_.increments) strapdown_.Add(part);
    };
    ForEachStep(window, interval.begin, interval.end, visit);
    sample.w_WS_S_rad_s = gyro_.ReadFormed(point_ ? step_.w : Vector3d(w / steps), saturated.gyro);
    sample.f_WS_S_m_s2 = accel_.ReadFormed(point_ ? step_.f : Vector3d(f / steps), saturated.accel);
    if (params_.increments) {
      sample.increments = FormIncrements(steps * context_.truth_rate.Period_s(), sample, saturated);
    }
    sample.flags.saturated = saturated.bits();
  }

  ImuIncrements FormIncrements(double T, const ImuSample& sample, Saturated& saturated) const {
    if (!params_.coning_sculling) return Sums(T, sample);
    return {T * gyro_.ReadFormed(strapdown_.dtheta_rad() / T, saturated.gyro),
            T * accel_.ReadFormed(strapdown_.dv_m_s() / T, saturated.accel)};
  }

  void HoldStuckAxes(const Interval& interval, ImuSample& sample) {
    const double end_s = Seconds(interval.end), T = Seconds(interval.end - interval.begin);
    gyro_.StickRate(end_s, sample.w_WS_S_rad_s);
    accel_.StickRate(end_s, sample.f_WS_S_m_s2);
    if (!sample.increments) return;
    gyro_.StickIncrement(end_s, T, sample.increments->dtheta_S_rad);
    accel_.StickIncrement(end_s, T, sample.increments->dv_S_m_s);
  }

  /// The sample, the last one once more, or nothing.
  SensorValue Deliver(std::int64_t k, const ImuSample& sample) {
    if (plan_.BurstBeginsAt(k)) lost_until_ = k + plan_.loss_length();
    if (k < lost_until_) return LostSample{};
    const bool again = last_ && plan_.IsDuplicate(k);
    const RobotTime stamp = sample.stamp;
    if (!again) last_ = sample;
    ImuSample delivered = *last_;
    delivered.stamp = stamp;
    delivered.flags.duplicated = again;
    return delivered;
  }

  struct Step {
    std::int64_t n = 0;  ///< the last one taken
    Vector3d w = Vector3d::Zero();
    Vector3d f = Vector3d::Zero();
  };

  ImuParams params_;
  SamplingPlan plan_;
  Pose X_BS_;  ///< as the crew knows it
  Matrix3d R_SB_;
  bool point_;
  bool has_size_effect_;
  SensorContext context_;
  ImuTriad gyro_;
  ImuTriad accel_;
  bool by_steps_;  ///< the means over an interval are not enough
  Step step_;
  StrapdownSum strapdown_;
  std::int64_t next_ = 0;
  std::int64_t lost_until_ = 0;
  std::optional<ImuSample> last_;  ///< delivered
};

std::unique_ptr<Sensor> Make(const Params& params, const SensorContext& context) {
  const auto& p = static_cast<const ImuParams&>(params);
  p.Check(context);
  return std::make_unique<Imu>(p, context);
}

}  // namespace

SensorKind Kind() {
  return {"imu", "Gyroscope and accelerometer: means over the sampling interval, with their errors.", "imu",
          MakeParams<ImuParams>, Make};
}

}  // namespace piperun::sim::sensors::imu
