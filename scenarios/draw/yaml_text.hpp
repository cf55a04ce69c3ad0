// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace tumble::scenarios {

std::string yaml_number(double value, const std::string& place);

std::string yaml_word(const std::string& text);

}  // namespace tumble::scenarios
