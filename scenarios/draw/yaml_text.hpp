// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

/// yaml_text.hpp writes scalars as YAML text.
namespace tumble::scenarios {

/// Returns the shortest text that parses to the same double. Infinite values are `.inf` and `-.inf`. Throws BadInput
/// with `place` if the value is NaN.
std::string yaml_number(double value, const std::string& place);

/// Returns an identifier unchanged, and any other text in double quotes with YAML escapes.
std::string yaml_word(const std::string& text);

}  // namespace tumble::scenarios
