// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "scenarios/methods/method.hpp"

namespace tumble::scenarios {

/// The end error starts at this registered sweep (Deschenes et al.); the count starts at 1 with the sweep that starts
/// the map.
inline constexpr std::size_t kStartSweep = 6;

std::vector<std::size_t> registered_sweeps(const Estimate& estimate);

}  // namespace tumble::scenarios
