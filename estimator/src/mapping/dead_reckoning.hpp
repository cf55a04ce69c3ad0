// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "lag_window.hpp"
#include "prediction.hpp"
#include "world_covariance.hpp"

namespace tumble::mapping {

/// DeadReckoning predicts a second pose from the IMU. While a relocalisation is unconfirmed, the second pose is the
/// pose without it. After later sweeps have contradicted the relocalisation, the second pose is the relocalised pose.
struct DeadReckoning {
  SweepBoundary boundary;
  LagWindow window;
  WorldCovariance world;
  std::uint32_t inserted_from = 0;  ///< first sweep that was inserted into the map after the relocalisation
};

}  // namespace tumble::mapping
