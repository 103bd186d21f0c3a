#pragma once

#include <memory>

#include "estimator/ball_navigator.h"
#include "estimator/complementary_attitude.h"

namespace piperun::estimator {

template <class Gains>
struct ComplementaryFilterParams : ParamsOf<ComplementaryFilterParams<Gains>> {
  Gains gains;
  ComplementaryParams assumed;
  NavigatorParams navigator;

  void Visit(ParamVisitor& v) override {
    gains.Visit(v);
    v.Struct({"assumed", "What is assumed of the filter's errors and of the sensors."}, assumed);
    navigator.Visit(v);
  }
};

/// A whole estimator around a filter of fixed gains (estimator/complementary_attitude.h).
template <class Block, class Gains>
FilterKind MakeComplementaryKind(std::string_view name, std::string_view doc) {
  using Parameters = ComplementaryFilterParams<Gains>;
  return {name, doc, MakeParams<Parameters>,
          [](const Params& params, const EstimatorStart& start) -> std::unique_ptr<Estimator> {
            const auto& p = dynamic_cast<const Parameters&>(params);
            auto attitude =
                std::make_unique<ComplementaryAttitude<Block>>(Block(p.gains), p.assumed, start.field_W_T);
            const AssumedMotion assumed{.gyro_noise_rad_s_sqrtHz = p.assumed.gyro_noise_rad_s_sqrtHz,
                                        .gyro_bias_sd_rad_s = p.assumed.gyro_bias_sd_rad_s};
            return std::make_unique<BallNavigator>(p.navigator, assumed, std::move(attitude), start);
          },
          [](const Params& params) { return CalcNeeds(dynamic_cast<const Parameters&>(params).navigator); }};
}

}  // namespace piperun::estimator
