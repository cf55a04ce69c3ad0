// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "lag_window.hpp"
#include "prediction.hpp"
#include "world_covariance.hpp"

namespace tumble::mapping {

/// While a relocalisation is unconfirmed, DeadReckoning predicts the pose without the relocalisation from the IMU.
/// After sweeps have contradicted the relocalisation, DeadReckoning predicts the rejected pose, as a starting pose of
/// further searches.
struct DeadReckoning {
  SweepBoundary boundary;
  LagWindow window;
  WorldCovariance world;
  std::uint32_t inserted_from = 0;  ///< first sweep inserted into the map after the relocalisation
};

}  // namespace tumble::mapping
