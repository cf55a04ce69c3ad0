// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

/// The functions in yaml_text.hpp write a number or a text as YAML.
namespace tumble::scenarios {

/// Converts a number to the shortest text that parses to the same double. Infinite values are `.inf` and `-.inf`.
/// Throws BadInput with `place` if the value is NaN.
std::string yaml_number(double value, const std::string& place);

/// Returns an identifier unchanged, and any other text in double quotes with YAML escapes.
std::string yaml_word(const std::string& text);

}  // namespace tumble::scenarios
