#include "sim/script.h"

#include <algorithm>
#include <cmath>

namespace piperun::sim {
namespace {

Vector3d CalcSmoothMean(const Script& script, double begin_s, double end_s) {
  const double middle = 0.5 * (begin_s + end_s);
  const double offset = 0.5 * (end_s - begin_s) * std::sqrt(0.6);
  return (5 * (script.Eval(middle - offset).v_WB_W + script.Eval(middle + offset).v_WB_W) +
          8 * script.Eval(middle).v_WB_W) /
         18;
}

}  // namespace

Vector3d CalcMeanVelocity(const Script& script, double begin_s, double dt_s) {
  const std::vector<double>& knots = script.knots_s();
  const double end_s = begin_s + dt_s;
  Vector3d mean = Vector3d::Zero();
  double done = 0;  // part of the interval, 0 to 1
  for (auto knot = std::upper_bound(knots.begin(), knots.end(), begin_s);
       knot != knots.end() && *knot < end_s; ++knot) {
    const double part = (*knot - begin_s) / dt_s;
    mean += (part - done) * CalcSmoothMean(script, begin_s + done * dt_s, *knot);
    done = part;
  }
  return mean + (1 - done) * CalcSmoothMean(script, begin_s + done * dt_s, end_s);
}

}  // namespace piperun::sim
