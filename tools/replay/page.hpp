// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "tools/replay/replay.hpp"

namespace tumble::tools {

std::string replay_page(const Replay& replay);

}  // namespace tumble::tools
