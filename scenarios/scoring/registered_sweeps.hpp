// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "scenarios/estimates/method.hpp"

namespace tumble::scenarios {

/// Number of the registered sweep at which the motion for the end error starts (Deschenes et al.). The sweep that
/// starts the map has the number 1.
inline constexpr std::size_t kStartSweep = 6;

std::vector<std::size_t> registered_sweeps(const Estimate& estimate);

}  // namespace tumble::scenarios
