// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace tumble::scenarios {

/// Converts a number to the shortest text that parses to the same double. Throws BadInput with `place` if the value is
/// NaN.
std::string yaml_number(double value, const std::string& place);

/// Returns an identifier unchanged, and any other text in double quotes with YAML escapes.
std::string yaml_word(const std::string& text);

}  // namespace tumble::scenarios
