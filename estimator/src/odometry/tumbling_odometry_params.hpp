// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tumble/attitude/detail/regime_smoother.hpp"
#include "tumble/common/detail/outlier_filter.hpp"
#include "tumble/mapping/lidar_inertial_odometry.hpp"
#include "tumble/odometry/tumbling_expert_params.hpp"
#include "tumble/odometry/tumbling_odometry.hpp"

/// tumbling_odometry_params.hpp computes the parameters of rate estimation and mapping from TumblingOdometry::Params.
namespace tumble::odometry {

/// Returns the parameters of the rate estimation. Throws InvalidParams if a parameter of TumblingOdometry is out of
/// bounds.
RegimeStream::Params rate_params(const TumblingOdometry::Params& params);

/// Returns the parameters of the rate estimation over a whole recording. The parameters of RegimeSmoother equal those
/// of RegimeStream, except for larger prior standard deviations of accelerometer bias and inertia (see
/// RateStreamParams::model).
RegimeSmoother::Params recording_rate_params(const TumblingOdometry::Params& params);

OutlierFilter::Device outlier_params(const TumblingOdometry::Params& params);
LidarInertialOdometry::Params mapper_params(const TumblingOdometry::Params& params);

}  // namespace tumble::odometry
