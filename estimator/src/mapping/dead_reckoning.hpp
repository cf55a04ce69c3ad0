// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "lag_window.hpp"
#include "prediction.hpp"
#include "world_covariance.hpp"

namespace tumble::mapping {

/// DeadReckoning is a second pose hypothesis while a relocalisation is unconfirmed. The second hypothesis ignores the
/// relocalisation and uses only IMU and odometer. If a later sweep contradicts the relocalisation, the odometry
/// continues from the second hypothesis. The pose of the contradicted relocalisation is an additional starting pose of
/// the search in the map.
struct DeadReckoning {
  SweepBoundary sweep_boundary;
  LagWindow window;
  WorldCovariance world_covariance;
  std::uint32_t first_inserted_sweep = 0;  ///< first sweep inserted into the map after the relocalisation
};

}  // namespace tumble::mapping
