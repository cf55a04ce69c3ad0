// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "lag_window.hpp"
#include "prediction.hpp"
#include "world_covariance.hpp"

namespace tumble::mapping {

/// While a relocalisation is unconfirmed, DeadReckoning stores a second state, which ignores the relocalisation and
/// integrates only the IMU. If a later sweep contradicts the relocalisation, odometry and DeadReckoning swap their
/// poses. The search after a tracking failure also starts from the pose of the contradicted relocalisation.
struct DeadReckoning {
  SweepBoundary sweep_boundary;
  LagWindow window;
  WorldCovariance world_covariance;
  std::uint32_t first_inserted_sweep = 0;  ///< first sweep inserted into the map after the relocalisation
};

}  // namespace tumble::mapping
