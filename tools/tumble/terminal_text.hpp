// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

namespace tumble::tools {

/// Invalid UTF-8 and control characters (C0 except line ends, DEL, C1) become '?', because names in files and paths
/// could otherwise move the cursor.
std::string terminal_text(std::string_view text);

}  // namespace tumble::tools
