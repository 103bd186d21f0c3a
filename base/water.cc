#include "base/water.h"

#include <cmath>

#include "base/check.h"

namespace piperun {
namespace {

double Density(double t) {
  const double numerator =
      999.83952 +
      t * (16.945176 + t * (-7.9870401e-3 + t * (-46.170461e-6 + t * (105.56302e-9 - t * 280.54253e-12))));
  return numerator / (1 + 16.879850e-3 * t);
}

double DynamicViscosity(double t) {
  const double d = 20 - t;
  const double log10_ratio = d / (t + 96) * (1.2364 - 1.37e-3 * d + 5.7e-6 * d * d);
  return 1002e-6 * std::pow(10.0, log10_ratio);
}

double SoundSpeed(double t) {
  return 1402.385 +
         t * (5.038813 + t * (-5.799136e-2 + t * (3.287156e-4 + t * (-1.398845e-6 + t * 2.787860e-9))));
}

}  // namespace

WaterProperties CalcWater(double temperature_C) {
  Demand(temperature_C >= 0 && temperature_C <= 60, "water temperature lies between 0 and 60 C");
  const double density = Density(temperature_C);
  return {temperature_C, density, DynamicViscosity(temperature_C) / density, SoundSpeed(temperature_C)};
}

}  // namespace piperun
