#include <memory>

#include "estimator/attitude_ekf.h"
#include "estimator/ball_navigator.h"
#include "estimator/printed_ekf.h"

namespace piperun::estimator::filters::quaternion_ekf {
namespace {

struct QuaternionEkfParams : ParamsOf<QuaternionEkfParams> {
  bool printed = false;
  AttitudeParams attitude;
  NavigatorParams navigator;

  void Visit(ParamVisitor& v) override {
    v.Flag({"printed", "Use the attitude filter in the form the paper prints, for comparison."}, printed);
    v.Struct({"attitude", "What is assumed of sensors and motion."}, attitude);
    navigator.Visit(v);
  }
};

std::unique_ptr<AttitudeFilter> MakeAttitude(const QuaternionEkfParams& params, const EstimatorStart& start) {
  if (params.printed)
    return std::make_unique<PrintedEkf>(params.attitude, start.gravity_m_s2, start.field_W_T);
  return std::make_unique<AttitudeEkf>(params.attitude, start.gravity_m_s2, start.field_W_T);
}

std::unique_ptr<Estimator> Make(const Params& params, const EstimatorStart& start) {
  const auto& p = dynamic_cast<const QuaternionEkfParams&>(params);
  const AssumedMotion assumed{p.attitude.gyro_noise_rad_s_sqrtHz, p.attitude.gyro_bias_sd_rad_s,
                              p.attitude.motion_acceleration_sd_m_s2};
  return std::make_unique<BallNavigator>(p.navigator, assumed, MakeAttitude(p, start), start);
}

ChannelNeeds Needs(const Params& params) {
  return CalcNeeds(dynamic_cast<const QuaternionEkfParams&>(params).navigator);
}

}  // namespace

FilterKind Kind() {
  return {"quaternion_ekf",
          "Attitude, gyro bias and scale by an extended Kalman filter; position by rolling or between rests.",
          MakeParams<QuaternionEkfParams>, Make, Needs};
}

}  // namespace piperun::estimator::filters::quaternion_ekf
