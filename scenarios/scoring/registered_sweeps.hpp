// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "scenarios/methods/method.hpp"

namespace tumble::scenarios {

/// The end error starts here: the sixth sweep that was registered (Deschenes et al.), counted from 1. The first is the
/// map's.
inline constexpr std::size_t kStartSweep = 6;

/// Indices of the sweeps that were not rejected.
std::vector<std::size_t> registered_sweeps(const Estimate& estimate);

}  // namespace tumble::scenarios
