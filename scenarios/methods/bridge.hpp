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
#include "tumble/odometry/sensor_sheets.hpp"

/// bridge.hpp converts the records of the library `sim` to the messages of the library `estimator`. The conventions of
/// the two libraries compare as follows:
///
/// - The time of a sample is the end of its averaging window [ns] in both libraries.
/// - The rate is that of I relative to W, in the axes of I [rad/s], in both libraries.
/// - The specific force is in the axes of I [m/s^2], with +g upward at rest, in both libraries.
/// - The clip flags in sim are bits 0 to 5 for gyro x y z and accelerometer x y z; the estimator uses ClipFlag.
/// - The IMU mounting in sim is T_BI with B at the centre of mass; the estimator uses the lever arm from B to I in axes
///   of I.
/// - The lidar mounting in sim is T_BL; the estimator uses T_IL.
/// - A lidar point is in metres in L, with the time offset from the sweep's start [ns], in both libraries.
namespace tumble::scenarios::bridge {

/// Longest accepted gap between two IMU samples [s]. Methods that cannot restart use kGapMaxS; methods that continue
/// after any gap use kAnyGapS.
inline constexpr double kGapMaxS = 1.0, kAnyGapS = std::numeric_limits<double>::infinity();

/// A reading is accepted up to kStatedRangesMax times the measurement range in the IMU record. Real saturation limits
/// exceed the stated range (MTi-30: by a factor of 1.4), and a tilted saturation plane allows even larger readings.
/// Larger readings cannot be measurements.
inline constexpr double kStatedRangesMax = OutlierFilter::kStatedRangesMax;

/// The conversion rejects a recording if the share of readings out of range exceeds kWildShareMax, because the unit or
/// the stated device must be wrong.
inline constexpr double kWildShareMax = 0.01;

/// Returns the noise and range parameters of an IMU record. Parameters that the record lacks keep the library's
/// defaults.
ImuSheet imu_sheet(const sim::ImuRecord& record);

/// Returns `out_of_range`, with value and limit, for the first axis whose reading exceeds kStatedRangesMax times the
/// measurement range. A measurement range of 0 disables the check.
Status check_range(const sim::ImuRecord& record, const Eigen::Vector3d& gyro_rad_s, const Eigen::Vector3d& accel_m_s2);

/// Returns true for each usable sample of an IMU. A sample is unusable if it is not finite, exceeds the range of any
/// sensor, or has a time stamp out of order. If such samples are not rare (may_leave_out), all of them count as usable.
/// A sample is also unusable if OutlierFilter rejects it. If the arrays of the IMU record differ in length, all samples
/// count as usable. The cost is O(N log N).
std::vector<bool> find_inliers(const sim::ImuRecord& record);

/// Converts the samples of an IMU, in order, without the faulty readings (find_inliers). Possible errors are `empty`,
/// `non_finite`, `time_order`, `gap` (more than `gap_max_s`) and `out_of_range`. The last error means that check_range
/// failed, or that the median time step differs 20-fold from the stated sample period. On error, `out` is empty. Throws
/// BadInput if the arrays of the record differ in length. The cost is O(N).
Status imu_samples(const sim::ImuRecord& record, std::vector<ImuSample>& out, double gap_max_s = kGapMaxS);

/// Converts the samples of the primary IMU. Returns `empty` if the recording has no IMU.
Status primary_imu_samples(const sim::Sensors& sensors, std::vector<ImuSample>& out, double gap_max_s = kGapMaxS);

/// Converts the samples of the IMU, with the true readings before saturation from `truth`. Throws BadInput if `truth`
/// and the IMU record do not match.
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

/// Returns the number of sweeps in a lidar record. Throws BadInput if the arrays of the lidar record are inconsistent.
std::size_t sweep_count(const sim::LidarRecord& record);

/// kRounding_ns is the tolerance for rounded time stamps [ns]. Time stamps stored as seconds since 1970 in a double
/// have rounding errors of up to a quarter of kRounding_ns.
inline constexpr std::int64_t kRounding_ns = 1000;

/// Converts the sweep `index`, which must be less than sweep_count(record). The sweep ends after one period, or at the
/// start of the next sweep if this is earlier. Points up to kRounding_ns after the end get the time of the end; later
/// points are dropped. A sweep without a time per point has zero duration, so it is not deskewed. The cost is
/// proportional to the number of points.
Sweep sweep(const sim::LidarRecord& record, std::size_t index);

}  // namespace tumble::scenarios::bridge
