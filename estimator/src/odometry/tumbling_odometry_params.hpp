// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tumble/attitude/detail/regime_smoother.hpp"
#include "tumble/common/detail/outlier_filter.hpp"
#include "tumble/mapping/lidar_inertial_odometry.hpp"
#include "tumble/odometry/expert_params.hpp"
#include "tumble/odometry/tumbling_odometry.hpp"

namespace tumble::odometry {

/// Throws InvalidParams if a parameter of TumblingOdometry is out of bounds.
MotionRegimeStream::Params rate_stream_params(const TumblingOdometry::Params& params);

/// When estimating a whole recording, the prior standard deviations of accelerometer bias and inertia are larger than
/// in live operation (see AngularRateStreamParams::model).
MotionRegimeSmoother::Params recording_rate_params(const TumblingOdometry::Params& params);

OutlierFilter::ImuRanges outlier_params(const TumblingOdometry::Params& params);
LidarInertialOdometry::Params mapper_params(const TumblingOdometry::Params& params);

}  // namespace tumble::odometry
