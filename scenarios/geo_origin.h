#pragma once

#include <optional>

#include "base/params.h"
#include "base/pose.h"

namespace piperun::scenarios {

/// A place on the ellipsoid of WGS 84.
struct GeoPoint {
  double latitude_deg = 0;
  double longitude_deg = 0;
  double height_m = 0;  ///< above the ellipsoid
};

/// Where on earth the world frame's origin lies, if that is known: x points east, y north, z up there. What
/// is said of heights is above the same surface as the network's elevations.
struct GeoOrigin {
  std::optional<double> latitude_deg, longitude_deg;
  void Visit(ParamVisitor& v);
  bool known() const { return latitude_deg && longitude_deg; }
};

/// The place of a point of W. By way of the geocentric frame: p_E = p_E(origin) + R_EW p_W, and back to
/// latitude and height by fixed-point iteration on the ellipsoid's normal (error below 1e-15 rad). Straight
/// lines of W stay straight, so that z of a level pipe 10 km from the origin lies 8 m above the ellipsoid.
/// Range: a known origin off the poles; |p_W| below a thousand kilometres.
GeoPoint CalcGeoPoint(const GeoOrigin& origin, const Vector3d& p_W);

}  // namespace piperun::scenarios
