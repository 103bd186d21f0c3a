#include "scenarios/dig_points.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

namespace piperun::scenarios {
namespace {

TEST(GeoOrigin, MetresPerDegreeAreTheEllipsoids) {
  // lengths of a degree at 45 degrees on WGS 84 (NIMA TR8350.2, 3rd edition, table of the reference
  // ellipsoid): 111131.8 m of latitude, 78846.8 m of longitude
  const GeoOrigin origin{45.0, 7.0};
  EXPECT_NEAR(CalcGeoPoint(origin, {0, 100, 0}).latitude_deg - 45, 100 / 111131.8, 1e-9);
  EXPECT_NEAR(CalcGeoPoint(origin, {100, 0, 0}).longitude_deg - 7, 100 / 78846.8, 1e-8);
}

TEST(GeoOrigin, TheTangentPlaneLeavesTheEarth) {
  // d^2 / (2 R): 10 km off, R between 6335 and 6400 km: 7.8 to 7.9 m
  EXPECT_NEAR(CalcGeoPoint({52.0, 5.0}, {10e3, 0, 0}).height_m, 7.83, 0.06);
  const GeoPoint up = CalcGeoPoint({52.0, 5.0}, {0, 0, 123});
  EXPECT_NEAR(up.height_m, 123, 1e-6);
  EXPECT_NEAR(up.latitude_deg, 52, 1e-11);
  EXPECT_NEAR(up.longitude_deg, 5, 1e-11);
}

TEST(GeoOrigin, SouthAndWestAreNegative) {
  const GeoPoint at = CalcGeoPoint({-33.0, -70.0}, {-1000, -1000, 0});
  EXPECT_LT(at.latitude_deg, -33);
  EXPECT_LT(at.longitude_deg, -70);
}

TEST(DigPoints, ArePointsWithLongitudeFirst) {
  estimator::LeakEstimate leak;
  leak.chainage_m = 12.5;
  leak.sigma_m = 0.2;
  leak.interval = {12.1, 12.9};
  leak.p_W = {100, 0, 0};
  leak.flow_m3_s = 1e-3 / 60;
  leak.flow_sigma_dB = 7.5;
  leak.confidence = 0.9;
  const auto json = nlohmann::json::parse(WriteDigPoints({45.0, 7.0}, {leak}));
  EXPECT_EQ(json.at("type"), "FeatureCollection");
  const auto& feature = json.at("features").at(0);
  EXPECT_EQ(feature.at("geometry").at("type"), "Point");
  EXPECT_NEAR(feature.at("geometry").at("coordinates").at(0).get<double>(), 7 + 100 / 78846.8, 2e-8);
  EXPECT_NEAR(feature.at("geometry").at("coordinates").at(1).get<double>(), 45, 2e-8);
  EXPECT_NEAR(feature.at("properties").at("flow_L_min").get<double>(), 1, 1e-12);
  // 1.96 * 7.5 dB = 14.7 dB of amplitude: a factor of 5.43
  EXPECT_NEAR(feature.at("properties").at("flow_interval_L_min").at(1).get<double>(), 5.43, 0.01);
}

TEST(DigPoints, WithoutLeaksAreAnEmptyCollection) {
  const auto json = nlohmann::json::parse(WriteDigPoints({45.0, 7.0}, {}));
  EXPECT_TRUE(json.at("features").empty());
}

}  // namespace
}  // namespace piperun::scenarios
