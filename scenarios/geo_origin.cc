#include "scenarios/geo_origin.h"

#include <cmath>
#include <numbers>

#include "base/check.h"

namespace piperun::scenarios {
namespace {

constexpr double kEquator_m = 6378137, kFlattening = 1 / 298.257223563;  // WGS 84
constexpr double kEccentricity2 = kFlattening * (2 - kFlattening);
constexpr double kRad_per_deg = std::numbers::pi / 180;

/// Of the ellipsoid's normal, down to the axis.
double NormalRadius_m(double latitude_rad) {
  const double s = std::sin(latitude_rad);
  return kEquator_m / std::sqrt(1 - kEccentricity2 * s * s);
}

Vector3d Geocentric_m(double latitude_rad, double longitude_rad) {
  const double n = NormalRadius_m(latitude_rad);
  return {n * std::cos(latitude_rad) * std::cos(longitude_rad),
          n * std::cos(latitude_rad) * std::sin(longitude_rad),
          n * (1 - kEccentricity2) * std::sin(latitude_rad)};
}

/// Columns: east, north, up in geocentric axes.
Matrix3d CalcR_EW(double latitude_rad, double longitude_rad) {
  const double sb = std::sin(latitude_rad), cb = std::cos(latitude_rad);
  const double sl = std::sin(longitude_rad), cl = std::cos(longitude_rad);
  Matrix3d R;
  R << -sl, -sb * cl, cb * cl, cl, -sb * sl, cb * sl, 0, cb, sb;
  return R;
}

}  // namespace

void GeoOrigin::Visit(ParamVisitor& v) {
  v.NumberOr({"latitude_deg", "Latitude of the coordinates' origin, WGS 84; for places on a map."},
             Range::Between(-89, 89), "unknown", latitude_deg);
  v.NumberOr({"longitude_deg", "Its longitude."}, Range::Between(-180, 180), "unknown", longitude_deg);
}

GeoPoint CalcGeoPoint(const GeoOrigin& origin, const Vector3d& p_W) {
  Demand(origin.known(), "places on earth need an origin");
  const double latitude_rad = *origin.latitude_deg * kRad_per_deg;
  const double longitude_rad = *origin.longitude_deg * kRad_per_deg;
  const Vector3d p_E =
      Geocentric_m(latitude_rad, longitude_rad) + CalcR_EW(latitude_rad, longitude_rad) * p_W;
  const double rho_m = std::hypot(p_E.x(), p_E.y());
  // tan(latitude) = (z + N e^2 sin(latitude)) / rho: contracts by e^2 per step
  double b_rad = std::atan2(p_E.z(), rho_m * (1 - kEccentricity2));
  for (int i = 0; i < 8; ++i)
    b_rad = std::atan2(p_E.z() + NormalRadius_m(b_rad) * kEccentricity2 * std::sin(b_rad), rho_m);
  const double height_m =
      rho_m * std::cos(b_rad) + p_E.z() * std::sin(b_rad) - kEquator_m * kEquator_m / NormalRadius_m(b_rad);
  return {b_rad / kRad_per_deg, std::atan2(p_E.y(), p_E.x()) / kRad_per_deg, height_m};
}

}  // namespace piperun::scenarios
