// The whole simulator, linked as a library: Bullet, yaml-cpp, libsndfile and OpenSSL come with it.
#include <cstdio>
#include <string>

#include "acoustics/source.h"
#include "scenarios/materials.h"
#include "sim/motion.h"
#include "sim/sensor.h"

int main() {
  const auto materials = piperun::scenarios::MaterialNames();
  std::printf("%zu motions, %zu sensors, %zu leak sounds, %zu materials\n", piperun::sim::MotionKinds().size(),
              piperun::sim::SensorKinds().size(), piperun::acoustics::LeakSoundKinds().size(), materials.size());
  return piperun::sim::MotionKinds().empty() || piperun::sim::SensorKinds().empty() || materials.empty() ? 1 : 0;
}
