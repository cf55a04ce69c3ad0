// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "tools/report/page.hpp"

namespace tumble::tools {

/// The first screen: what was compared, who does best by how much and how sure that is, and one moving picture.
std::string front_html(const PageContent& content);

}  // namespace tumble::tools
