// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

/// Scalars as they are written into YAML files of ours.
namespace tumble::scenarios {

/// Shortest text that reads back as the same double; `.inf` and `-.inf`. Throws BadInput with `place` for NaN.
std::string yaml_number(double value, const std::string& place);

/// Plain for identifiers, else in double quotes with YAML's escapes.
std::string yaml_word(const std::string& text);

}  // namespace tumble::scenarios
