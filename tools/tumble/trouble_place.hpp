// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "sim/recording.hpp"
#include "tumble/common/status.hpp"

namespace tumble::tools {

std::string trouble_place(const Status& status, const sim::Sensors& sensors);

}  // namespace tumble::tools
