// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "tumble/odometry/rolling_odometry.hpp"

/// Parameters of the parts of RollingOdometry, derived from its own parameters.
namespace tumble::odometry {

/// Returns the parameters of ImuMerge. Throws InvalidParams if a parameter of RollingOdometry is out of bounds.
ImuMerge::Params merge_params(const RollingOdometry::Params& params);

/// Returns the parameters of the smoother for `units` IMUs. `lever_arm_m` is the position of the merged IMU.
RollingSmoother::Params rolling_params(const RollingOdometry::Params& params, const ImuMerge::Params& merged,
                                       std::size_t units, const Eigen::Vector3d& lever_arm_m);

/// Returns the data sheets, the detectors of frozen axes and the outlier filters of all units.
std::vector<ImuSheet> sheets_of(const RollingOdometry::Params& params);
std::vector<FrozenAxes> frozen_axis_detectors(const RollingOdometry::Params& params);
std::vector<OutlierFilter> filters_of(const RollingOdometry::Params& params);

}  // namespace tumble::odometry
