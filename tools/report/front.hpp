// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "tools/report/page.hpp"

namespace tumble::tools {

std::string front_html(const PageContent& content);

}  // namespace tumble::tools
