#include "scenarios/dig_points.h"

#include <cmath>
#include <nlohmann/json.hpp>

namespace piperun::scenarios {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kLitrePerMinute = 60e3;
constexpr double kQuantile975 = 1.959963984540054;

double Round(double degrees) { return std::round(degrees * 1e8) / 1e8; }

Json MakeProperties(const estimator::LeakEstimate& leak) {
  Json properties{{"chainage_m", leak.chainage_m},
                  {"sigma_m", leak.sigma_m},
                  {"interval_m", Json::array({leak.interval.low_m, leak.interval.high_m})},
                  {"confidence", leak.confidence}};
  if (leak.at) properties["at"] = *leak.at;
  if (!leak.flow_m3_s) return properties;
  const double flow_L_min = kLitrePerMinute * *leak.flow_m3_s;
  const double ratio = std::pow(10, kQuantile975 * leak.flow_sigma_dB / 20);
  properties["flow_L_min"] = flow_L_min;
  properties["flow_interval_L_min"] = Json::array({flow_L_min / ratio, flow_L_min * ratio});
  return properties;
}

}  // namespace

std::string WriteDigPoints(const GeoOrigin& origin, const std::vector<estimator::LeakEstimate>& leaks) {
  Json features = Json::array();
  for (const estimator::LeakEstimate& leak : leaks) {
    const GeoPoint at = CalcGeoPoint(origin, leak.p_W);
    features.push_back({{"type", "Feature"},
                        {"geometry",
                         {{"type", "Point"},
                          {"coordinates", Json::array({Round(at.longitude_deg), Round(at.latitude_deg)})}}},
                        {"properties", MakeProperties(leak)}});
  }
  const Json json{{"type", "FeatureCollection"}, {"features", features}};
  return json.dump(2) + "\n";
}

}  // namespace piperun::scenarios
