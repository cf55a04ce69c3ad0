// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "sim/recording.hpp"
#include "tumble/common/status.hpp"

namespace tumble::tools {

/// If no sweep was registered, the text is the number of points in a sweep.
std::string trouble_place(const Status& status, const sim::Sensors& sensors);

}  // namespace tumble::tools
