#include <nlohmann/json.hpp>

#include "base/check.h"
#include "base/number.h"
#include "scenarios/detect.h"
#include "scenarios/dig_points.h"

namespace piperun::scenarios {

std::string WriteDetectionsJson(const Detections& detections) {
  using Json = nlohmann::ordered_json;
  Json leaks = Json::array();
  for (const estimator::LeakEstimate& leak : detections.leaks) {
    leaks.push_back(
        {{"time_s", Seconds(leak.t_cpa)},
         {"chainage_m", detections.placed ? Json(leak.chainage_m) : Json()},
         {"sigma_m", detections.placed ? Json(leak.sigma_m) : Json()},
         {"interval_m",
          detections.placed ? Json(Json::array({leak.interval.low_m, leak.interval.high_m})) : Json()},
         {"confidence", leak.confidence},
         {"at", leak.at ? Json(*leak.at) : Json()},
         {"flow_m3_s", leak.flow_m3_s ? Json(*leak.flow_m3_s) : Json()},
         {"flow_sigma_dB", leak.flow_m3_s ? Json(leak.flow_sigma_dB) : Json()}});
  }
  const Json json{{"schema", "piperun.detect/1"},
                  {"audio", detections.audio},
                  {"locator", detections.locator},
                  {"rate_Hz", detections.rate_Hz},
                  {"duration_s", detections.duration_s},
                  {"full_scale_samples", detections.full_scale_samples},
                  {"interval_holds", detections.placed ? Json(detections.interval_holds) : Json()},
                  {"detections", leaks}};
  return json.dump(2) + "\n";
}

std::string WriteDetectionsCsv(const Detections& detections) {
  std::string csv = "time_s,chainage_m,sigma_m,confidence,flow_m3_s,flow_sigma_dB,at\n";
  for (const estimator::LeakEstimate& leak : detections.leaks) {
    const std::string place =
        detections.placed ? FormatNumber(leak.chainage_m) + "," + FormatNumber(leak.sigma_m) : ",";
    csv += FormatNumber(Seconds(leak.t_cpa)) + "," + place + "," + FormatNumber(leak.confidence) + ",";
    csv += leak.flow_m3_s ? FormatNumber(*leak.flow_m3_s) + "," + FormatNumber(leak.flow_sigma_dB) : ",";
    csv += "," + leak.at.value_or("") + "\n";
  }
  return csv;
}

std::string WriteDetectionsGeoJson(const Detections& detections) {
  if (!detections.origin) {
    throw InputError(
        "the pipe file says nothing of where on earth the pipe lies; give it line_m (rows of east, north, "
        "up) "
        "and origin {latitude_deg, longitude_deg}",
        "--geojson");
  }
  return WriteDigPoints(*detections.origin, detections.leaks);
}

}  // namespace piperun::scenarios
