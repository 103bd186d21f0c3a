#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "base/check.h"
#include "sim/sensor.h"
#include "tests/support/set_params.h"

namespace piperun::testing {

inline sim::SensorContext MakeSensorContext(std::uint64_t run = 0, std::string_view channel = "sensor0") {
  return {.random = RandomStream(7, channel, run), .clock = {}, .seed = 7, .run = run};
}

inline std::unique_ptr<sim::Sensor> MakeSensor(std::string_view kind_name, const ParamValues& values,
                                               const sim::SensorContext& context = MakeSensorContext()) {
  const sim::SensorKind& kind = FindKind(sim::SensorKinds(), kind_name);
  return kind.make(*MakeParamsOf(kind, values), context);
}

/// A thousand steps a second, each as `set` makes it of a state that rests at the origin.
inline sim::TruthWindow MakeWindow(std::int64_t steps, const std::function<void(sim::TruthState&)>& set) {
  sim::TruthWindow window(Rate(1000), static_cast<std::size_t>(steps) + 1);
  for (std::int64_t k = 0; k <= steps; ++k) {
    sim::TruthState state;
    state.time = SampleTime(k, Rate(1000));
    set(state);
    window.Push(state);
  }
  return window;
}

/// What `make` refuses: the key.
inline std::string FindRefusedKey(const std::function<void()>& make) {
  try {
    make();
  } catch (const InputError& e) {
    return e.key_path();
  }
  return "nothing";
}

}  // namespace piperun::testing
