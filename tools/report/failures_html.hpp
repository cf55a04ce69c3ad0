// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "tools/report/page.hpp"

namespace tumble::tools {

/// Shows the fraction of failures of each method and the baseline, then the failed runs: methods, commands to reproduce
/// them, and links to pictures and replays.
std::string failures_html(const PageContent& content);

}  // namespace tumble::tools
