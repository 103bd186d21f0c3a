#include "estimator/vqf.h"

#include <memory>

#include "estimator/ball_navigator.h"

namespace piperun::estimator::filters::vqf {
namespace {

struct VqfKindParams : ParamsOf<VqfKindParams> {
  VqfParams vqf;
  ComplementaryParams assumed;
  NavigatorParams navigator;

  void Visit(ParamVisitor& v) override {
    vqf.Visit(v);
    v.Struct({"assumed", "What is assumed of the filter's errors and of the sensors."}, assumed);
    navigator.Visit(v);
  }
};

std::unique_ptr<Estimator> Make(const Params& params, const EstimatorStart& start) {
  const auto& p = dynamic_cast<const VqfKindParams&>(params);
  const AssumedMotion assumed{.gyro_noise_rad_s_sqrtHz = p.assumed.gyro_noise_rad_s_sqrtHz,
                              .gyro_bias_sd_rad_s = p.assumed.gyro_bias_sd_rad_s};
  return std::make_unique<BallNavigator>(p.navigator, assumed,
                                         std::make_unique<Vqf>(p.vqf, p.assumed, start.field_W_T), start);
}

ChannelNeeds Needs(const Params& params) {
  return CalcNeeds(dynamic_cast<const VqfKindParams&>(params).navigator);
}

}  // namespace

FilterKind Kind() {
  return {"vqf", "Inclination in the almost inertial frame, bias and heading apart, as VQF does.",
          MakeParams<VqfKindParams>, Make, Needs};
}

}  // namespace piperun::estimator::filters::vqf
