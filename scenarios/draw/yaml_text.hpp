// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

/// Scalars as written to YAML files.
namespace tumble::scenarios {

/// Returns the shortest text that parses to the same double, also `.inf` and `-.inf`. Throws BadInput with `place` for
/// NaN.
std::string yaml_number(double value, const std::string& place);

/// Returns an identifier unchanged, other text in double quotes with YAML escapes.
std::string yaml_word(const std::string& text);

}  // namespace tumble::scenarios
