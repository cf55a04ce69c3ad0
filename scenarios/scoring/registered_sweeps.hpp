// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "scenarios/methods/method.hpp"

namespace tumble::scenarios {

/// kStartSweep is the number of the registered sweep, counted from 1, at which the end error starts (Deschenes et al.).
/// The count includes the first sweep, which starts the map.
inline constexpr std::size_t kStartSweep = 6;

/// Returns the indices of the sweeps that were not rejected.
std::vector<std::size_t> registered_sweeps(const Estimate& estimate);

}  // namespace tumble::scenarios
