// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "scenarios/estimates/estimate.hpp"
#include "tools/tables/table.hpp"
#include "tools/tumble/importing.hpp"

namespace tumble::tools {

using scenarios::RecordingSetting;

/// Detects the data sheets of the first IMU and lidar, and the attitude of a lidar without a known pose, and stores
/// them in the recording.
///
/// @param own_body_L  Bounding box of the robot in lidar axes, for display only; points inside are dropped. A box of
/// size 0 drops no points.
std::vector<RecordingSetting> complete_recording(const Session& session, OpenRecording& recording,
                                                 const Eigen::AlignedBox3d& own_body_L, bool own_body_stated);

/// Returns whether the user or the recording states the pose of the lidar.
bool states_lidar_pose(const std::vector<RecordingSetting>& items);

/// Adds the lidar pose that the estimator used instead of the stated pose.
void set_replaced_pose(const Eigen::Isometry3d& T_BL, std::vector<RecordingSetting>& items);

/// Standard deviations of the lidar pose if neither an option nor the recording states it; found_table() shows them.
inline constexpr double kAssumedLidarSigma_m = 0.1, kAssumedLidarSigma_rad = 0.05;

Table found_table(const std::vector<RecordingSetting>& items);
nlohmann::json found_document(const std::vector<RecordingSetting>& items);

}  // namespace tumble::tools
