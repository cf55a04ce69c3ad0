// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "lag_window.hpp"
#include "prediction.hpp"
#include "world_covariance.hpp"

namespace tumble::mapping {

/// DeadReckoning predicts an alternative pose from inertial data. During an unconfirmed relocalisation, the alternative
/// is the pose without the relocalisation. After a contradicted relocalisation, the alternative is the contradicted
/// pose.
struct DeadReckoning {
  SweepBoundary boundary;
  LagWindow window;
  WorldCovariance world;
  std::uint32_t inserted_from = 0;  ///< first sweep that was inserted into the map after the relocalisation
};

}  // namespace tumble::mapping
