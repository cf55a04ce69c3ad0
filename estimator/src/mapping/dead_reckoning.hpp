// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "lag_window.hpp"
#include "prediction.hpp"
#include "world_covariance.hpp"

namespace tumble::mapping {

/// A second opinion of where the sensor is, by inertia alone: beside a place that was found again, what stands if it is
/// none; beside one who is lost again, the place that was contradicted.
struct DeadReckoning {
  Border border;
  LagWindow window;
  WorldCovariance world;
  std::uint32_t drawn_from = 0;  ///< the first of the map's sweeps that the place drew
};

}  // namespace tumble::mapping
