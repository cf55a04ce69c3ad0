// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "tools/replay/replay.hpp"

namespace tumble::tools {

/// One self-contained page that plays the replay: styles, scripts and data inside; it asks the network nothing and runs
/// from the file system. Every text of the replay is data in it, never markup.
std::string replay_page(const Replay& replay);

}  // namespace tumble::tools
