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

/// The functions in bridge.hpp convert the records of the library `sim` to the messages of the estimator. The libraries
/// `sim` and `estimator` each document their conventions. The following list compares the conventions of `sim` and
/// `estimator`:
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

/// Methods that cannot restart accept at most kGapMaxS seconds between two IMU samples; methods that continue after any
/// gap use kAnyGapS.
inline constexpr double kGapMaxS = 1.0, kAnyGapS = std::numeric_limits<double>::infinity();

/// A reading is accepted as a measurement up to kStatedRangesMax times the measurement range in the IMU record. Real
/// saturation levels exceed the range in the data sheet (MTi-30: 1.4 times the range). A tilted saturation plane allows
/// even larger readings. Readings beyond kStatedRangesMax times the measurement range cannot be measurements.
inline constexpr double kStatedRangesMax = OutlierFilter::kStatedRangesMax;

/// The conversion rejects a recording if more than the fraction kWildShareMax of its readings is out of range, because
/// unit or device must be wrong.
inline constexpr double kWildShareMax = 0.01;

/// Returns the noise and range parameters of an IMU record. The library's defaults replace parameters that the IMU
/// record lacks.
ImuSheet imu_sheet(const sim::ImuRecord& record);

/// Returns `out_of_range`, with value and limit, for the first axis whose reading exceeds kStatedRangesMax times the
/// measurement range. A measurement range of 0 disables the check.
Status check_range(const sim::ImuRecord& record, const Eigen::Vector3d& gyro_rad_s, const Eigen::Vector3d& accel_m_s2);

/// Returns for each sample of an IMU whether the sample is usable. A sample is unusable if it is not finite, exceeds
/// the range of any sensor, or has a time stamp out of order. Samples with one of these faults are rejected only if the
/// faults are rare (may_leave_out). A sample is also unusable if the library's OutlierFilter rejects it. All samples
/// count as usable if the arrays of the IMU record differ in length. The cost is O(N log N).
std::vector<bool> find_inliers(const sim::ImuRecord& record);

/// Converts the samples of an IMU, in order, and drops the faulty readings that find_inliers rejects. The possible
/// errors are `empty`, `non_finite`, `time_order`, `gap` (more than `gap_max_s`) and `out_of_range`. The error
/// `out_of_range` comes from check_range, or from a median time step that differs 20-fold from the sample period of the
/// IMU. On error, `out` is empty. Throws BadInput if the arrays of the IMU record differ in length. The cost is O(N).
Status imu_samples(const sim::ImuRecord& record, std::vector<ImuSample>& out, double gap_max_s = kGapMaxS);

/// Converts the samples of the primary IMU. Returns `empty` if the recording has no IMU.
Status primary_imu_samples(const sim::Sensors& sensors, std::vector<ImuSample>& out, double gap_max_s = kGapMaxS);

/// Converts the samples of the IMU, with the true readings before saturation from `truth`. Throws BadInput if `truth`
/// does not belong to the IMU record.
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

/// Converts the sweep with number `index`, which must be less than sweep_count(record). The sweep ends after one
/// period, or earlier, at the start of the next sweep. The times of points up to kRounding_ns after the sweep's end are
/// set to the end. Points more than kRounding_ns after the sweep's end are dropped. A sweep without a time per point
/// has zero duration, so it is not deskewed. The cost is proportional to the number of points of the sweep.
Sweep sweep(const sim::LidarRecord& record, std::size_t index);

}  // namespace tumble::scenarios::bridge
