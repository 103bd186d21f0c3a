#pragma once

#include <string>
#include <utility>

namespace piperun::scenarios {

/// Factor to SI and SI unit of a group's values. A group called gyro, accel, mag or pressure measures rad/s,
/// m/s^2, T or Pa, others anything; throws InputError for an unknown unit or one that measures something
/// else.
std::pair<double, std::string> ResolveGroupUnit(const std::string& group, const std::string& unit);

}  // namespace piperun::scenarios
