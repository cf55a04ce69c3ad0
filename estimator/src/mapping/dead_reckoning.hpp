// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "lag_window.hpp"
#include "prediction.hpp"
#include "world_covariance.hpp"

namespace tumble::mapping {

/// After an unconfirmed relocalisation, DeadReckoning continues the pose from before the relocalisation with the IMU
/// alone. If a later sweep contradicts the relocalisation, odometry and DeadReckoning swap their poses. The rejected
/// pose remains a starting pose of the search after a tracking failure.
struct DeadReckoning {
  SweepBoundary sweep_boundary;
  LagWindow window;
  WorldCovariance world_covariance;
  std::uint32_t first_inserted_sweep = 0;  ///< first sweep inserted into the map after the relocalisation
};

}  // namespace tumble::mapping
