#include "acoustics/network_field.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <numbers>
#include <utility>

#include "base/random.h"
#include "tests/acoustics/scenes.h"

namespace piperun::acoustics {
namespace {

using Complex = std::complex<double>;

constexpr Complex kI(0, 1);

/// A wave of the given speed and bore with hardly any loss: 1e-12 Np/m.
PipeWave MakeLosslessWave(double speed_m_s, double bore_diameter_m) {
  PipeWave wave = MakeIronWave();
  wave.loss_factor = 0;
  wave.kinematic_viscosity_m2_s *= 1e-18;
  wave.speed_m_s = speed_m_s;
  wave.bore_radius_m = bore_diameter_m / 2;
  wave.area_m2 = std::numbers::pi * wave.bore_radius_m * wave.bore_radius_m;
  wave.impedance_Pa_s_m3 = 1000 * speed_m_s / wave.area_m2;
  return wave;
}

Complex CalcK(const PipeWave& wave, double f_Hz) {
  return {2 * std::numbers::pi * f_Hz / wave.speed_m_s, -wave.Attenuation_Np_m(f_Hz)};
}

Complex FieldAt(const AcousticNetwork& network, const PipePlace& source, const PipePlace& place,
                double f_Hz) {
  return NetworkField(network, {source}, {f_Hz}).Impedance_Pa_s_m3(0, 0, place);
}

void ExpectNear(Complex a, Complex b, double relative) {
  EXPECT_LT(std::abs(a - b), relative * std::abs(b)) << a << " instead of " << b;
}

TEST(NetworkField, APipeThatGoesOnBothWaysCarriesHalfTheImpedance) {
  for (const PipeWave& wave : {MakePvcWave(), MakeIronWave()}) {
    const AcousticNetwork network{{{0, 1, 60, wave}}, {NodeEnd::kGoesOn, NodeEnd::kGoesOn}, {}, {}};
    for (const double f_Hz : {20.0, 437.0, 3000.0}) {
      for (const double x_m : {-8.0, -0.3, 0.0, 2.5, 30.0}) {
        const Complex expected =
            wave.impedance_Pa_s_m3 / 2 * std::exp(-kI * CalcK(wave, f_Hz) * std::abs(x_m));
        if (std::abs(expected) < 1e-4 * wave.impedance_Pa_s_m3) continue;
        ExpectNear(FieldAt(network, {0, 20}, {0, 20 + x_m}, f_Hz), expected, 1e-10);
      }
    }
  }
}

TEST(NetworkField, ADeadEndReturnsTheWaveAndOpenWaterTurnsItOver) {
  const PipeWave wave = MakeIronWave();
  for (const auto& [end, sign] : {std::pair{NodeEnd::kClosed, 1.0}, {NodeEnd::kOpenWater, -1.0}}) {
    const AcousticNetwork network{{{0, 1, 50, wave}}, {NodeEnd::kGoesOn, end}, {}, {}};
    for (const double s_m : {3.0, 20.0, 41.0, 50.0}) {
      const double f_Hz = 310;
      const Complex k = CalcK(wave, f_Hz);
      const Complex expected =
          wave.impedance_Pa_s_m3 / 2 *
          (std::exp(-kI * k * std::abs(s_m - 20)) + sign * std::exp(-kI * k * ((50 - 20) + (50 - s_m))));
      EXPECT_LT(std::abs(FieldAt(network, {0, 20}, {0, s_m}, f_Hz) - expected),
                1e-9 * wave.impedance_Pa_s_m3);
    }
  }
}

TEST(NetworkField, BeyondADeadEndThePipeGoesOnAsItIs) {
  const PipeWave wave = MakeIronWave();
  const AcousticNetwork network{{{0, 1, 50, wave}}, {NodeEnd::kGoesOn}, {}, {}};
  const Complex k = CalcK(wave, 200);
  const double s_m = 50.03;
  const Complex expected =
      wave.impedance_Pa_s_m3 / 2 * (std::exp(-kI * k * (s_m - 20)) + std::exp(-kI * k * (30 + (50 - s_m))));
  ExpectNear(FieldAt(network, {0, 20}, {0, s_m}, 200), expected, 1e-10);
}

/// What passes from the first pipe, which holds the source, into the second at node 1, in dB.
double CalcTransmission_dB(const std::vector<PipeWave>& branches) {
  AcousticNetwork network{{}, {NodeEnd::kGoesOn, NodeEnd::kClosed}, {}, {}};
  for (std::size_t i = 0; i < branches.size(); ++i) {
    network.pipes.push_back({i == 0 ? 0 : 1, i == 0 ? 1 : static_cast<int>(i) + 1, 10, branches[i]});
    if (i > 0) network.ends.push_back(NodeEnd::kGoesOn);
  }
  const double at_node = std::abs(FieldAt(network, {0, 4}, {1, 0}, 237));
  return 20 * std::log10(at_node / (branches[0].impedance_Pa_s_m3 / 2));
}

TEST(NetworkField, JunctionsPassAndReflectByTheirAdmittances) {
  const auto bore = [](double mm) { return MakeLosslessWave(1250, 1e-3 * mm); };
  // T = 2 Y1 / sum Y with Y ~ A: an equal tee, a narrower and a wider pipe, a side branch
  EXPECT_NEAR(CalcTransmission_dB({bore(150), bore(150), bore(150)}), 20 * std::log10(2.0 / 3), 1e-9);
  EXPECT_NEAR(CalcTransmission_dB({bore(200), bore(150)}), 20 * std::log10(2 / (1 + 0.5625)), 1e-9);
  EXPECT_NEAR(CalcTransmission_dB({bore(150), bore(300)}), 20 * std::log10(2.0 / 5), 1e-9);
  EXPECT_NEAR(CalcTransmission_dB({bore(150), bore(150), bore(20)}), 20 * std::log10(2 / (2 + 4.0 / 225)),
              1e-9);
  EXPECT_NEAR(CalcTransmission_dB({bore(150), MakeLosslessWave(400, 0.15)}),
              20 * std::log10((2 / 1250.0) / (1 / 1250.0 + 1 / 400.0)), 1e-9);
}

TEST(NetworkField, ALumpedValveReflectsByItsResistance) {
  const PipeWave wave = MakeLosslessWave(1250, 0.15);
  const double zc = wave.impedance_Pa_s_m3, resistance = 0.7 * zc;
  const AcousticNetwork network{{{0, 1, 30, wave}, {2, 3, 30, wave}},
                                {NodeEnd::kGoesOn, NodeEnd::kClosed, NodeEnd::kClosed, NodeEnd::kGoesOn},
                                {{1, 2, resistance}},
                                {}};
  // behind a series resistance: T = 2 Zc / (2 Zc + R), in front 1 + R / (2 Zc + R)
  const double f_Hz = 100;
  EXPECT_NEAR(std::abs(FieldAt(network, {0, 10}, {1, 5}, f_Hz)), zc / 2 * 2 / 2.7, 1e-6 * zc);
  EXPECT_NEAR(std::abs(FieldAt(network, {0, 10}, {0, 30}, f_Hz)), zc / 2 * (1 + 0.7 / 2.7), 1e-6 * zc);
}

TEST(NetworkField, AnOpenHoleTakesItsShare) {
  const PipeWave wave = MakeLosslessWave(1250, 0.15);
  const double yc = 1 / wave.impedance_Pa_s_m3;
  // 100 L/min at 3 bar: r = -Y/(2 Yc + Y), behind it 1 + r
  const double y = 0.1 / 60 / (2 * 3e5), r = -y / (2 * yc + y);
  const AcousticNetwork network{{{0, 1, 40, wave}}, {NodeEnd::kGoesOn, NodeEnd::kGoesOn}, {}, {{{0, 25}, y}}};
  EXPECT_NEAR(r, -0.089, 0.001);
  EXPECT_NEAR(std::abs(FieldAt(network, {0, 10}, {0, 33}, 150)), (1 + r) / (2 * yc), 1e-6 / yc);
}

/// Some 20 to 40 nodes in a ring with chords, spurs, valves and open water, drawn.
AcousticNetwork DrawNetwork(std::uint64_t seed) {
  const RandomStream random(seed, "network", 0);
  const auto u = [&](std::uint64_t i) { return random.Uniforms(i, 0); };
  AcousticNetwork network;
  const int n = 20 + static_cast<int>(20 * u(0)[0]);
  const auto wave = [&](double x) {
    return x < 0.4 ? MakePvcWave() : x < 0.8 ? MakeIronWave() : MakeLosslessWave(1100, 0.1);
  };
  for (int i = 0; i < n; ++i) {
    const auto d = u(static_cast<std::uint64_t>(i) + 1);
    network.pipes.push_back({i, (i + 1) % n, 1 + 30 * d[0], wave(d[1])});
    if (d[2] < 0.4)
      network.pipes.push_back({i, (i + 3 + static_cast<int>(5 * d[3])) % n, 2 + 20 * d[3], wave(d[0])});
    network.ends.push_back(d[3] < 0.1 ? NodeEnd::kOpenWater : NodeEnd::kClosed);
  }
  network.links.push_back({2, n / 2, 1e6});
  network.holes.push_back({{1, 0.5 * network.pipes[1].length_m}, 2e-9});
  return network;
}

/// The same field by another formulation: amplitudes of the two waves in every pipe as unknowns, every pipe
/// divided by hand where a source, a hole or the listener is; in every node equal pressures and balanced
/// flows.
class WaveAmplitudes {
 public:
  WaveAmplitudes(const AcousticNetwork& network, double f_Hz) : network_(network), f_Hz_(f_Hz) {}

  Complex Field(const PipePlace& source, const PipePlace& place) {
    nodes_ = static_cast<int>(network_.ends.size());
    pipes_ = network_.pipes;
    next_.assign(pipes_.size(), 0);
    const int at_source = Cut(source), at_hole = Cut(network_.holes[0].place), at_place = Cut(place);
    const auto m = static_cast<Eigen::Index>(2 * pipes_.size());
    const Eigen::Index links = static_cast<Eigen::Index>(network_.links.size());
    // unknowns: forward and backward of every pipe, pressure of every node, flow of every link
    const Eigen::Index size = m + nodes_ + links;
    const double z0 = pipes_[0].wave.impedance_Pa_s_m3;
    Eigen::MatrixXcd a = Eigen::MatrixXcd::Zero(size, size);
    Eigen::VectorXcd b = Eigen::VectorXcd::Zero(size);
    Eigen::Index row = 0;
    for (std::size_t i = 0; i < pipes_.size(); ++i) {
      const AcousticPipe& pipe = pipes_[i];
      const Complex e = std::exp(-kI * CalcK(pipe.wave, f_Hz_) * pipe.length_m);
      const auto f = static_cast<Eigen::Index>(2 * i);
      const double y = z0 / pipe.wave.impedance_Pa_s_m3;  // flows count in units of 1/z0
      a(row, f) = 1, a(row, f + 1) = e, a(row, m + pipe.from_node) = -1, ++row;
      a(row, f) = e, a(row, f + 1) = 1, a(row, m + pipe.to_node) = -1, ++row;
      a(m + pipe.from_node, f) += y, a(m + pipe.from_node, f + 1) -= y * e;
      a(m + pipe.to_node, f) -= y * e, a(m + pipe.to_node, f + 1) += y;
    }
    for (Eigen::Index i = 0; i < links; ++i) {
      const LumpedLink& link = network_.links[static_cast<std::size_t>(i)];
      const Eigen::Index q = m + nodes_ + i;
      a(q, m + link.from_node) = 1, a(q, m + link.to_node) = -1, a(q, q) = -link.resistance_Pa_s_m3 / z0;
      a(m + link.from_node, q) += 1, a(m + link.to_node, q) -= 1;
    }
    a(m + at_hole, m + at_hole) += z0 * network_.holes[0].admittance_m3_s_Pa;
    b(m + at_source) = z0;
    for (std::size_t node = 0; node < network_.ends.size(); ++node) {
      if (network_.ends[node] != NodeEnd::kOpenWater) continue;
      const Eigen::Index r = m + static_cast<Eigen::Index>(node);
      a.row(r).setZero(), a(r, r) = 1, b(r) = 0;
    }
    return a.partialPivLu().solve(b)(m + at_place);
  }

 private:
  /// The node at a place; divides the piece of the pipe that holds it.
  int Cut(const PipePlace& place) {
    auto piece = static_cast<std::size_t>(place.pipe);
    double s_m = place.s_m;
    for (; s_m > pipes_[piece].length_m; piece = next_[piece]) s_m -= pipes_[piece].length_m;
    if (s_m < 1e-12) return pipes_[piece].from_node;
    if (pipes_[piece].length_m - s_m < 1e-12) return pipes_[piece].to_node;
    AcousticPipe rest = pipes_[piece];
    rest.from_node = pipes_[piece].to_node = nodes_;
    rest.length_m -= s_m;
    pipes_[piece].length_m = s_m;
    next_.push_back(std::exchange(next_[piece], pipes_.size()));
    pipes_.push_back(rest);
    return nodes_++;
  }

  const AcousticNetwork& network_;
  double f_Hz_;
  int nodes_ = 0;
  std::vector<AcousticPipe> pipes_;
  std::vector<std::size_t> next_;  // piece of the same pipe, of every pipe or piece
};

TEST(NetworkField, EqualsADenseSolutionForTheWaves) {
  double worst = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const AcousticNetwork network = DrawNetwork(seed);
    const PipePlace source{3, 0.37 * network.pipes[3].length_m};
    const NetworkField field(network, {source}, {17, 33, 120});
    for (std::size_t f = 0; f < 3; ++f) {
      for (const PipePlace& place :
           {source, PipePlace{1, 0.2}, PipePlace{3, 0.9}, PipePlace{9, 0.8}, PipePlace{14, 0}}) {
        const Complex expected = WaveAmplitudes(network, field.frequencies_Hz()[f]).Field(source, place);
        const double scale = network.pipes[3].wave.impedance_Pa_s_m3;
        worst = std::max(worst, std::abs(field.Impedance_Pa_s_m3(f, 0, place) - expected) / scale);
      }
    }
  }
  std::printf("largest difference from the dense solution: %.1e\n", worst);
  EXPECT_LT(worst, 1e-8);
}

TEST(NetworkField, SourceAndListenerMayChangePlaces) {
  const AcousticNetwork network = DrawNetwork(7);
  const PipePlace a{3, 0.4}, b{11, 0.7}, c{3, 0.9};
  const NetworkField field(network, {a, b, c}, {25, 60});
  for (std::size_t f = 0; f < 2; ++f) {
    ExpectNear(field.Impedance_Pa_s_m3(f, 0, b), field.Impedance_Pa_s_m3(f, 1, a), 1e-9);
    ExpectNear(field.Impedance_Pa_s_m3(f, 0, c), field.Impedance_Pa_s_m3(f, 2, a), 1e-9);
  }
}

TEST(NetworkField, DividingAPipeChangesNothing) {
  const AcousticNetwork network = DrawNetwork(3);
  const PipePlace source{3, 0.4};
  const NetworkField whole(network, {source}, {80}),
      divided(network, {source, {5, 0.3}, {6, 0.9}, {5, 0.8}}, {80});
  for (int pipe = 0; pipe < static_cast<int>(network.pipes.size()); ++pipe) {
    const Complex expected = whole.Impedance_Pa_s_m3(0, 0, {pipe, 0.6});
    EXPECT_LT(std::abs(divided.Impedance_Pa_s_m3(0, 0, {pipe, 0.6}) - expected),
              1e-9 * std::abs(expected) + 1e-3);
  }
}

TEST(NetworkField, LosslessJunctionsKeepTheEnergy) {
  // pipes that go on for ever: what goes out at their ends is what the source gives off, Re(p q*) / 2
  for (const double f_Hz : {41.0, 333.0, 1207.0}) {
    AcousticNetwork network;
    network.pipes = {{0, 1, 11, MakeLosslessWave(1250, 0.15)},
                     {1, 2, 7, MakeLosslessWave(1100, 0.3)},
                     {1, 3, 5, MakeLosslessWave(400, 0.1)},
                     {1, 4, 3, MakeLosslessWave(1300, 0.08)}};  // a dead end
    network.ends = {NodeEnd::kGoesOn, NodeEnd::kClosed, NodeEnd::kGoesOn, NodeEnd::kGoesOn};
    const PipePlace source{0, 4};
    const NetworkField field(network, {source}, {f_Hz});
    const auto power = [&](const PipePlace& place) {
      const double zc = network.pipes[static_cast<std::size_t>(place.pipe)].wave.impedance_Pa_s_m3;
      return 0.5 * std::norm(field.Impedance_Pa_s_m3(0, 0, place)) / zc;
    };
    const double given = 0.5 * field.Impedance_Pa_s_m3(0, 0, source).real();
    EXPECT_NEAR((power({0, 0}) + power({1, 7}) + power({2, 5})) / given, 1, 1e-10) << f_Hz;
  }
}

TEST(NetworkField, NoPowerIsLeftInAJunction) {
  // the power that the two waves of a pipe carry into its ends is Yc (|p out|^2 - |p in|^2) / 2
  const AcousticNetwork network = DrawNetwork(5);
  const PipePlace source{3, 0.4};
  for (const double f_Hz : {30.0, 170.0}) {
    const NetworkField field(network, {source}, {f_Hz});
    std::vector<double> sum(network.ends.size() + 2), largest(sum.size());
    for (std::size_t i = 0; i <= network.pipes.size() + 1; ++i) {
      const NetworkField::Stretch& s = field.stretch(i);
      const NetworkField::Waves waves = field.FindWaves(0, 0, i);
      const PipeWave& wave = network.pipes[static_cast<std::size_t>(s.pipe)].wave;
      const double loss = std::exp(-2 * wave.Attenuation_Np_m(f_Hz) * s.length_m),
                   yc = 1 / wave.impedance_Pa_s_m3;
      const auto add = [&](int node, double out, double in) {
        sum[static_cast<std::size_t>(node)] += yc / 2 * (out - in);
        double& most = largest[static_cast<std::size_t>(node)];
        most = std::max(most, yc / 2 * std::max(in, out));
      };
      add(s.from_node, std::norm(waves.forward), loss * std::norm(waves.backward));
      add(s.to_node, std::norm(waves.backward), loss * std::norm(waves.forward));
    }
    for (std::size_t node = 0; node < network.ends.size(); ++node) {
      const bool link = node == 2 || node == network.ends.size() / 2;
      if (link || network.ends[node] != NodeEnd::kClosed) continue;
      EXPECT_LE(std::abs(sum[node]), 1e-10 * largest[node]) << f_Hz << " Hz, node " << node;
    }
  }
}

TEST(NetworkField, WhatIsLeftOutIsInaudible) {
  // 500 m of plastic with a dead end: at 500 Hz the far part is left out, at 20 Hz it is not
  const PipeWave wave = MakePvcWave();
  const AcousticNetwork network{
      {{0, 1, 200, wave}, {1, 2, 90, wave}, {2, 3, 10, wave}}, {NodeEnd::kGoesOn}, {}, {}};
  const NetworkField field(network, {{0, 190}}, {20, 500});
  EXPECT_GT(std::abs(field.Impedance_Pa_s_m3(0, 0, {2, 5})), 0);
  EXPECT_EQ(field.Impedance_Pa_s_m3(1, 0, {2, 5}), Complex(0));
  const Complex k = CalcK(wave, 500);
  ExpectNear(field.Impedance_Pa_s_m3(1, 0, {1, 5}), wave.impedance_Pa_s_m3 / 2 * std::exp(-kI * k * 15.0),
             1e-8);
}

}  // namespace
}  // namespace piperun::acoustics
