// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "tumble/angular_velocity/detail/frozen_axes.hpp"
#include "tumble/angular_velocity/detail/streaming_clipping_finder.hpp"
#include "tumble/attitude/detail/imu_merge.hpp"
#include "tumble/common/detail/outlier_filter.hpp"
#include "tumble/odometry/expert_params.hpp"

namespace tumble::odometry {

/// Throws InvalidParams if a parameter of RollingOdometry is out of bounds.
ImuMerge::Setup merge_setup(const RollingOdometry::Params& params);

/// `lever_arm_m` is the position of the virtual IMU that merges the readings of all `units` IMUs.
RollingSmoother::Params rolling_params(const RollingOdometry::Params& params, const ImuMerge::Setup& merged,
                                       std::size_t units, const Eigen::Vector3d& lever_arm_m);

/// Returns one StreamingClippingFinder per IMU. `known` contains the saturation levels of each IMU from an earlier run,
/// or is empty.
std::vector<StreamingClippingFinder> clipping_finders_of(const RollingOdometry::Params& params,
                                                         std::span<const SaturationLevels> known = {});
std::vector<FrozenAxes> frozen_axis_detectors(const RollingOdometry::Params& params);
std::vector<OutlierFilter> outlier_filters_of(const RollingOdometry::Params& params);

}  // namespace tumble::odometry
