// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "scenarios/methods/method.hpp"

namespace tumble::scenarios {

/// The end error starts at this registered sweep (Deschenes et al.), counted from 1, which is the sweep that starts the
/// map.
inline constexpr std::size_t kStartSweep = 6;

/// Returns the indices of the sweeps that were not rejected.
std::vector<std::size_t> registered_sweeps(const Estimate& estimate);

}  // namespace tumble::scenarios
