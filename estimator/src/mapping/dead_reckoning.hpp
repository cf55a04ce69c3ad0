// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "lag_window.hpp"
#include "prediction.hpp"
#include "world_covariance.hpp"

namespace tumble::mapping {

/// DeadReckoning predicts an alternative pose from the IMU after a relocalisation. While the relocalisation is
/// unconfirmed, the alternative is the pose without the relocalisation. If later sweeps contradict the relocalisation,
/// the alternative becomes the relocalised pose.
struct DeadReckoning {
  SweepBoundary boundary;
  LagWindow window;
  WorldCovariance world;
  std::uint32_t inserted_from = 0;  ///< first sweep inserted into the map after the relocalisation
};

}  // namespace tumble::mapping
