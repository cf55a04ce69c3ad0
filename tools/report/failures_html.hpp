// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "tools/report/page.hpp"

namespace tumble::tools {

/// Shares of failures beside the baseline's, then the draws that failed: on which methods, how they are made again, and
/// links to their pictures and replays where the examples have them.
std::string failures_html(const PageContent& content);

}  // namespace tumble::tools
