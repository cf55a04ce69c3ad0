// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "tools/report/page.hpp"

namespace tumble::tools {

/// Shows the shares of failures next to the baseline's, then the failed draws: methods, commands to reproduce them, and
/// links to pictures and replays where available.
std::string failures_html(const PageContent& content);

}  // namespace tumble::tools
