#pragma once

namespace piperun::acoustics {

struct Phasor {
  float cos, sin;
};

/// cos and sin of 2 pi x for |x| <= 0.5 within 1e-6. Sums and products only, so that a loop over it runs in
/// vector registers and gives the same bits with every mathematics library: those of a quarter of the angle,
/// by Taylor polynomials of degree 8 and 9, doubled twice.
inline Phasor CalcPhasor(float turns) {
  const float a = turns * 1.57079632679F;  // a quarter of the angle, within pi/4
  const float s = a * a;
  float c = 1.F / 40320;
  c = c * s - 1.F / 720;
  c = c * s + 1.F / 24;
  c = c * s - 0.5F;
  c = c * s + 1;
  float d = 1.F / 362880;
  d = d * s - 1.F / 5040;
  d = d * s + 1.F / 120;
  d = d * s - 1.F / 6;
  d = a * (d * s + 1);
  const float c2 = 1 - 2 * d * d, d2 = 2 * c * d;
  return {1 - 2 * d2 * d2, 2 * c2 * d2};
}

}  // namespace piperun::acoustics
