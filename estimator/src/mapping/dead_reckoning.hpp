// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "lag_window.hpp"
#include "prediction.hpp"
#include "world_covariance.hpp"

namespace tumble::mapping {

/// What stands if a place that was found again is none: the motion by inertia alone from before it was found, and from
/// which of the map's sweeps on the place has drawn.
struct DeadReckoning {
  Border border;
  LagWindow window;
  WorldCovariance world;
  std::uint32_t drawn_from = 0;
};

}  // namespace tumble::mapping
