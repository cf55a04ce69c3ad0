// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

namespace tumble::tools {

/// A text as it may reach a terminal: bytes that are no UTF-8 and control characters (C0 but for line ends, DEL, C1)
/// become '?'. What a file calls itself, or a path, must not move a cursor.
std::string terminal_text(std::string_view text);

}  // namespace tumble::tools
