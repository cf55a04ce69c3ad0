// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "lag_window.hpp"
#include "prediction.hpp"
#include "world_covariance.hpp"

namespace tumble::mapping {

/// DeadReckoning predicts the pose from the IMU, without an unconfirmed relocalisation. If later sweeps contradict the
/// relocalisation, DeadReckoning predicts the rejected pose, which remains a starting pose of the search.
struct DeadReckoning {
  SweepBoundary boundary;
  LagWindow window;
  WorldCovariance world;
  std::uint32_t inserted_from = 0;  ///< first sweep inserted into the map after the relocalisation
};

}  // namespace tumble::mapping
