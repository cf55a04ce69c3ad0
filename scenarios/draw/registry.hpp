// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>
#include <vector>

#include "sim/situation.hpp"

namespace tumble::scenarios {

/// What scenario files and data sheets are checked against: the types that the simulation knows.
struct Registry {
  std::span<const sim::ComponentType> worlds;
  std::span<const sim::ComponentType> robots;
  std::span<const sim::ComponentType> motions;
  std::span<const sim::ComponentType> sensors;
  std::span<const sim::Parameter> mount_error;

  /// The registries of this build.
  static Registry of_simulation();
};

/// Null when no type is called `name`.
const sim::ComponentType* find_type(std::span<const sim::ComponentType> types, const std::string& name);
/// Null when no parameter is called `name`.
const sim::Parameter* find_parameter(std::span<const sim::Parameter> parameters, const std::string& name);
std::vector<std::string> names_of(std::span<const sim::ComponentType> types);
std::vector<std::string> names_of(std::span<const sim::Parameter> parameters);

}  // namespace tumble::scenarios
