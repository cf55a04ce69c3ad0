// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "scenarios/draw/scenario.hpp"
#include "scenarios/draw/strict_yaml.hpp"

namespace tumble::scenarios {

NamedCase case_from_yaml(const YamlNode& node);
std::string to_yaml(const NamedCase& named);

}  // namespace tumble::scenarios
