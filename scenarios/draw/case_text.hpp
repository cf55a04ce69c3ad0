// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "scenarios/draw/named_case.hpp"
#include "scenarios/draw/strict_yaml.hpp"

namespace tumble::scenarios {

/// The value of the key `case` and back, without loss. Reading is strict: an unknown key, a method twice, neither
/// `fails` nor `holds`, a bound without its metric are refused with file and line.
NamedCase case_from_yaml(const YamlNode& node);
std::string to_yaml(const NamedCase& named);

}  // namespace tumble::scenarios
