// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>
#include <vector>

#include "sim/situation.hpp"

namespace tumble::scenarios {

/// Registry contains the component types (robots, sensors, worlds) that scenario files and data sheets may name.
struct Registry {
  std::span<const sim::ComponentType> worlds;
  std::span<const sim::ComponentType> robots;
  std::span<const sim::ComponentType> motions;
  std::span<const sim::ComponentType> sensors;
  std::span<const sim::Parameter> mount_error;

  /// Returns the component types that this build can simulate.
  static Registry of_simulation();
};

/// Returns the component type `name`, or null if `types` does not contain it.
const sim::ComponentType* find_type(std::span<const sim::ComponentType> types, const std::string& name);
/// Returns the parameter `name`, or null if `parameters` does not contain it.
const sim::Parameter* find_parameter(std::span<const sim::Parameter> parameters, const std::string& name);
std::vector<std::string> names_of(std::span<const sim::ComponentType> types);
std::vector<std::string> names_of(std::span<const sim::Parameter> parameters);

}  // namespace tumble::scenarios
