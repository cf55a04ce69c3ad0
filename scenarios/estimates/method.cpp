// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/estimates/method.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace tumble::scenarios {

std::string full_name(const MethodInfo& info) {
  return full_name(info.kind, info.name);
}

std::string MethodInfo::why_not(const Subject& subject) const {
  const bool known = !robots.empty() && !subject.robot.empty();
  if (known && std::find(robots.begin(), robots.end(), subject.robot) == robots.end())
    return fmt::format("does not support the robot '{}'", subject.robot);
  if (kind == Kind::slam && !subject.has_lidar) return "needs a lidar, but the recording has none";
  return {};
}

MethodPointer unowned(const Method& method) {
  return {std::shared_ptr<void>(), &method};
}

}  // namespace tumble::scenarios
