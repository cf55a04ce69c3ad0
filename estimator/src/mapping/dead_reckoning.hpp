// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "lag_window.hpp"
#include "prediction.hpp"
#include "world_covariance.hpp"

namespace tumble::mapping {

/// Alternative pose by inertial prediction. During an unconfirmed relocalisation, the alternative is the pose without
/// the relocalisation. After a contradicted relocalisation, the alternative is the contradicted pose.
struct DeadReckoning {
  Border border;
  LagWindow window;
  WorldCovariance world;
  std::uint32_t drawn_from = 0;  ///< first of the map's sweeps that were inserted after the relocalisation
};

}  // namespace tumble::mapping
