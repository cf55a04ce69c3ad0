// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "tools/report/page.hpp"

namespace tumble::tools {

/// Returns the first screen: the compared methods, the best methods with margin and certainty, and one animation.
std::string front_html(const PageContent& content);

}  // namespace tumble::tools
