// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "scenarios/estimates/method.hpp"

namespace tumble::scenarios {

/// The end error is computed for the motion after the registered sweep number kStartSweep (Deschenes et al.). The sweep
/// that starts the map has the number 1.
inline constexpr std::size_t kStartSweep = 6;

std::vector<std::size_t> registered_sweeps(const Estimate& estimate);

}  // namespace tumble::scenarios
