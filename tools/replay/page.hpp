// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "tools/replay/replay.hpp"

namespace tumble::tools {

/// Returns one page that plays the replay, with styles, scripts and data inside. The page works without network,
/// directly from the file system. Texts of the replay are embedded as data, never as markup.
std::string replay_page(const Replay& replay);

}  // namespace tumble::tools
