// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "sim/recording.hpp"
#include "tumble/angular_velocity/rate_state.hpp"
#include "tumble/common/detail/outlier_filter.hpp"
#include "tumble/common/imu.hpp"
#include "tumble/common/status.hpp"
#include "tumble/mapping/lidar.hpp"
#include "tumble/odometry/imu_sheet.hpp"

/// Converts the records of `sim` to the messages of the estimator. bridge.hpp contains every conversion between the two
/// libraries. Each of the two libraries states its conventions separately. The conventions of the libraries compare as
/// follows:
///
/// - Time: both libraries use the end of a sample's averaging window [ns].
/// - Rate: both libraries use the rate of I relative to W in the axes of I [rad/s].
/// - Specific force: both libraries use the axes of I [m/s^2], with +g upward at rest.
/// - Clip flags: sim has bits 0 to 5 for gyro x y z and accelerometer x y z; the estimator has ClipFlag.
/// - IMU mounting: sim has T_BI with B at the centre of mass; the estimator has the lever arm from B to I in axes of I.
/// - Lidar mounting: sim has T_BL; the estimator has T_IL.
/// - Lidar point: both libraries use metres in L and the offset from the sweep's start [ns].
namespace tumble::scenarios::bridge {

/// Longest time between two IMU samples [s] that methods without a restart accept, and the limit of methods that
/// continue after any gap.
inline constexpr double kGapMaxS = 1.0, kAnyGapS = std::numeric_limits<double>::infinity();

/// Readings up to kStatedRangesMax times the stated range are accepted as measurements. Real saturation levels exceed
/// the stated range (MTi-30: 1.4 times the range). A tilted saturation plane allows even larger readings. Larger
/// readings cannot be measurements.
inline constexpr double kStatedRangesMax = OutlierFilter::kStatedRangesMax;

/// The conversion rejects a recording if more than this fraction of its readings is out of range, because unit or
/// device must be wrong.
inline constexpr double kWildShareMax = 0.01;

/// Returns the data sheet of an IMU. The library's defaults replace values that the record does not state.
ImuSheet imu_sheet(const sim::ImuRecord& record);

/// Returns `out_of_range`, with value and limit, for the first axis whose reading exceeds kStatedRangesMax times the
/// range in the record. A stated range of 0 disables the check.
Status check_range(const sim::ImuRecord& record, const Eigen::Vector3d& gyro_rad_s, const Eigen::Vector3d& accel_m_s2);

/// Tests the samples of an IMU. Element k is false if sample k is not finite, exceeds the values of any sensor, or has
/// a stamp that is not in order. Samples with one of these faults are only rejected if the faults are rare
/// (may_leave_out). Element k is also false if the library's OutlierFilter rejects the sample. All samples pass if the
/// record's arrays differ in length. Cost: O(N log N).
std::vector<bool> find_inliers(const sim::ImuRecord& record);

/// Converts the samples of an IMU, in order, and drops the single faulty readings that find_inliers rejects. Returns
/// `empty`, `non_finite`, `time_order`, `gap` (more than `gap_max_s`) or `out_of_range`. The error `out_of_range` comes
/// from check_range, or from a median time step that differs 20-fold from the stated period. On error, `out` is empty.
/// Throws BadInput if the record's arrays differ in length. O(N).
Status imu_samples(const sim::ImuRecord& record, std::vector<ImuSample>& out, double gap_max_s = kGapMaxS);

/// Converts the primary IMU's samples. Returns `empty` if the recording has no IMU.
Status primary_imu_samples(const sim::Sensors& sensors, std::vector<ImuSample>& out, double gap_max_s = kGapMaxS);

/// Converts the samples of the IMU with the true, unsaturated readings of `truth`. Throws BadInput if `truth` does not
/// belong to the record.
Status unclipped_samples(const sim::ImuRecord& record, const sim::ImuTruth& truth, std::vector<ImuSample>& out);

/// Returns the vector from the centre of mass to the IMU, in IMU axes [m]: R_BI^T p_BI of the calibration.
Eigen::Vector3d lever_arm_I_m(const sim::ImuRecord& record);

/// Returns the transform from lidar to IMU coordinates, computed from the mountings of both sensors.
Eigen::Isometry3d T_IL(const sim::ImuRecord& imu, const sim::LidarRecord& lidar);

/// Returns the variance of one gyro reading per axis [(rad/s)^2], from the noise density of the data sheet and the
/// sample period.
double gyro_variance_rad2_s2(const sim::ImuRecord& record);

/// Sweep is one lidar sweep in the message format of the estimator.
struct Sweep {
  std::int64_t start_ns = 0;
  std::int64_t end_ns = 0;
  std::vector<LidarPoint> points;
};

/// Returns the number of sweeps. Throws BadInput if the record's arrays are inconsistent.
std::size_t sweep_count(const sim::LidarRecord& record);

/// kRounding_ns is the tolerance for rounded time stamps [ns]. Time stamps stored as seconds since 1970 in a double are
/// rounded by up to a quarter of this tolerance.
inline constexpr std::int64_t kRounding_ns = 1000;

/// Converts the sweep with number `index`, which must be less than sweep_count(record). The sweep ends after one
/// period, or at the start of the next sweep if that is earlier. Points up to kRounding_ns after the sweep's end are
/// moved to the end. Points that are later than this are dropped. A sweep without a time per point has zero length and
/// is not deskewed. The cost is proportional to the number of points of the sweep.
Sweep sweep(const sim::LidarRecord& record, std::size_t index);

}  // namespace tumble::scenarios::bridge
