#pragma once

#include <memory>

#include "estimator/attitude_model.h"
#include "estimator/ball_navigator.h"

namespace piperun::estimator {

struct AttitudeKindParams : ParamsOf<AttitudeKindParams> {
  AttitudeModelParams attitude;
  NavigatorParams navigator;

  void Visit(ParamVisitor& v) override {
    v.Struct({"attitude", "What is assumed of sensors and motion."}, attitude);
    navigator.Visit(v);
  }
};

/// A whole estimator around a Kalman filter of attitude and bias (estimator/attitude_kalman.h).
template <class Filter>
FilterKind MakeAttitudeKind(std::string_view name, std::string_view doc) {
  return {name, doc, MakeParams<AttitudeKindParams>,
          [](const Params& params, const EstimatorStart& start) -> std::unique_ptr<Estimator> {
            const auto& p = dynamic_cast<const AttitudeKindParams&>(params);
            const AssumedMotion assumed{p.attitude.gyro_noise_rad_s_sqrtHz, p.attitude.gyro_bias_sd_rad_s,
                                        p.attitude.motion_acceleration_sd_m_s2};
            auto attitude = std::make_unique<Filter>(p.attitude, start.gravity_m_s2, start.field_W_T);
            return std::make_unique<BallNavigator>(p.navigator, assumed, std::move(attitude), start);
          },
          [](const Params& params) {
            return CalcNeeds(dynamic_cast<const AttitudeKindParams&>(params).navigator);
          }};
}

}  // namespace piperun::estimator
