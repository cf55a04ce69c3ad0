// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <span>

#include "sim/engine/model.hpp"
#include "sim/recording.hpp"
#include "sim/situation.hpp"

namespace tumble::sim {

struct MotionTrack {
  std::int64_t period_ns = 0;
  std::span<const Eigen::Vector3d> p_WB_m;
  std::span<const Eigen::Quaterniond> q_WB;
};

/// Simulates the sweeps of a lidar. Each ray starts at the true lidar pose at the firing time of the ray. A ray without
/// a hit gives no point. The points do not depend on the number of threads.
void simulate_lidar(const engine::World& world, const SensorSpec& sensor, const Eigen::Isometry3d& T_BL,
                    const MotionTrack& motion, std::uint64_t seed, int threads, LidarRecord& record, LidarTruth& truth);

}  // namespace tumble::sim
