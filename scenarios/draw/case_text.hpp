// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "scenarios/draw/named_case.hpp"
#include "scenarios/draw/strict_yaml.hpp"

namespace tumble::scenarios {

/// The functions convert a NamedCase from and to the value of the YAML key `case`, without loss. Reading rejects an
/// unknown key, a repeated method, a `run` other than `fails` or `holds`, and a `worse_than` without a metric.
NamedCase case_from_yaml(const YamlNode& node);
std::string to_yaml(const NamedCase& named);

}  // namespace tumble::scenarios
