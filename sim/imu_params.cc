#include "sim/imu_params.h"

#include <array>

#include "base/check.h"
#include "base/number.h"

namespace piperun::sim {
namespace {

constexpr std::array<std::string_view, 2> kOutputs{"mean", "point"};

/// Names the group an error of one of its keys came from.
template <class Function>
void Within(const std::string& group, const Function& function) {
  try {
    function();
  } catch (const InputError& e) {
    throw InputError(e.problem(), group + "." + e.key_path(), e.where());
  }
}

}  // namespace

void ImuParams::Visit(ParamVisitor& v) {
  v.Number({"rate_Hz", "Sampling rate; at most the physics rate."}, Range::Between(0.1, 1e5), rate_Hz);
  v.Choice({"output", "What a sample is: the mean over its interval, or the value at its end."}, kOutputs,
           output);
  v.Flag({"increments", "Also deliver the angle and velocity increments of every interval."}, increments);
  v.Flag({"coning_sculling", "The sensor corrects its increments for its turning meanwhile; false: sums."},
         coning_sculling);
  v.Vector({"lever_arm_m", "Where the sensor sits in the ball frame B (origin at the ball's centre)."},
           Range::Between(-1, 1), lever_arm_m);
  v.Matrix({"accel_positions_m", "Where its x-, y- and z-accelerometer sit beside that, row by row, in S."},
           Range::Between(-0.1, 0.1), accel_positions_m);
  v.Vector({"mounting_rad", "Rotation vector of the sensor frame in B: q_BS = Exp(mounting_rad)."},
           Range::Between(-7, 7), mounting_rad);
  v.Vector({"mounting_error_rad", "How it is turned beyond that: q_BS = Exp(mounting_rad) Exp(this)."},
           Range::Between(-0.5, 0.5), mounting_error_rad);
  v.Number({"mounting_error_sd_rad", "Standard deviation of each component of it, drawn once per run."},
           Range::Between(0, 0.1), mounting_error_sd_rad);
  v.Struct({"sampling", "Scatter of the sampling instants and stamps; lost and repeated samples."}, sampling);
  v.Struct({"thermal", "Temperature of the sensor in the water."}, thermal);
  v.Number({"reference_C", "Temperature at which temperature_bias and temperature_scale add nothing."},
           Range::Between(-40, 125), reference_C);
  v.Group({"gyro", "Errors of the gyroscope."}, [this](ParamVisitor& g) { gyro.Visit(g, kGyroFields); });
  v.Group({"accel", "Errors of the accelerometer."},
          [this](ParamVisitor& a) { accel.Visit(a, kAccelFields); });
}

void ImuParams::Check(const SensorContext& context) const {
  if (rate_Hz > context.truth_rate.Hz()) {
    throw InputError(
        "an IMU cannot sample at " + FormatNumber(rate_Hz) + " Hz faster than the motion's physics rate of " +
            FormatNumber(context.truth_rate.Hz()) + " Hz; lower it or raise the motion's rate_Hz",
        "rate_Hz");
  }
  if (point() && increments) {
    throw InputError(
        "a sensor that delivers values at an instant (output: point) has no increments; set it to "
        "false, or output to mean",
        "increments");
  }
  Within("sampling", [&] { sampling.Check(Rate(rate_Hz)); });
  Within("gyro.filter", [&] { MakeImuFilter(gyro.filter, context.truth_rate); });
  Within("accel.filter", [&] { MakeImuFilter(accel.filter, context.truth_rate); });
}

}  // namespace piperun::sim
