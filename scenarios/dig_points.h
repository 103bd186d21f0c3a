#pragma once

#include <string>
#include <vector>

#include "estimator/estimator.h"
#include "scenarios/geo_origin.h"

namespace piperun::scenarios {

/// Leaks for a map on a crew's tablet: a GeoJSON FeatureCollection (RFC 7946) with a point, longitude and
/// latitude in degrees to 1e-8 (a millimetre), for each, and as properties chainage_m, sigma_m, interval_m
/// (95 %), confidence, `at` for one at a fitting of the map, and where the flow is known flow_L_min and
/// flow_interval_L_min (95 %). Range: a known origin.
std::string WriteDigPoints(const GeoOrigin& origin, const std::vector<estimator::LeakEstimate>& leaks);

}  // namespace piperun::scenarios
