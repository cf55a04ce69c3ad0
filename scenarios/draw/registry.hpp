// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>
#include <vector>

#include "sim/situation.hpp"

namespace tumble::scenarios {

struct Registry {
  std::span<const sim::ComponentType> worlds;
  std::span<const sim::ComponentType> robots;
  std::span<const sim::ComponentType> motions;
  std::span<const sim::ComponentType> sensors;
  std::span<const sim::Parameter> mount_error;

  static Registry of_simulation();
};

const sim::ComponentType* find_type(std::span<const sim::ComponentType> types, const std::string& name);
const sim::Parameter* find_parameter(std::span<const sim::Parameter> parameters, const std::string& name);
std::vector<std::string> names_of(std::span<const sim::ComponentType> types);
std::vector<std::string> names_of(std::span<const sim::Parameter> parameters);

}  // namespace tumble::scenarios
