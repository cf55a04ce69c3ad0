// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "sim/recording.hpp"
#include "tumble/angular_velocity/rate_state.hpp"
#include "tumble/common/detail/outlier_filter.hpp"
#include "tumble/common/imu.hpp"
#include "tumble/common/status.hpp"
#include "tumble/mapping/lidar.hpp"
#include "tumble/odometry/imu_sheet.hpp"

/// Converts the records of `sim` to the messages of the estimator. Every conversion between the two libraries is in
/// this file. Each library states its conventions separately; the table compares the conventions:
///
/// | quantity       | sim                                        | estimator                                      |
/// | -------------- | ------------------------------------------ | ---------------------------------------------- |
/// | time           | ns, end of the sample's window             | ns, the window ends there                      |
/// | rate           | rad/s, of I in W, I axes                   | w_WI_I, rad/s                                  |
/// | specific force | m/s^2, I axes, +g up at rest               | f_I, equal sign                                |
/// | clip flags     | bits 0..5: gyro x y z, accel x y z         | ClipFlag                                       |
/// | mounting       | T_BI, T_BL: sensor to body, B at the centre of mass | lever arm from B to I, in I axes; T_IL |
/// | lidar point    | m in L, offset ns after the sweep's start  | m in L, offset ns; one struct per point        |
namespace tumble::scenarios::bridge {

/// Longest accepted time between two IMU samples [s].
inline constexpr double kGapMaxS = 1.0;

/// Readings up to this multiple of the stated range are accepted as measurements. Real saturation levels exceed the
/// stated range (MTi-30: 1.4 times); tilted saturation planes exceed the range further. Larger readings cannot be
/// measurements.
inline constexpr double kStatedRangesMax = OutlierFilter::kRangesMax;

/// A recording is refused if a larger fraction of its readings exceeds the limit, because the unit or the device must
/// be wrong.
inline constexpr double kWildShareMax = 0.01;

/// Returns the data sheet of an IMU, with the library's defaults for what the record does not state.
ImuSheet imu_sheet(const sim::ImuRecord& record);

/// Returns `out_of_range`, with value and limit, for the first axis whose reading exceeds kStatedRangesMax times the
/// range in the record. A stated range of 0 disables the check.
Status check_range(const sim::ImuRecord& record, const Eigen::Vector3d& gyro_rad_s, const Eigen::Vector3d& accel_m_s2);

/// Tests the samples of an IMU. Element k is false if sample k is not finite, larger than any sensor reads, or has a
/// stamp that is not in order, or if the library's OutlierFilter rejects the sample. Samples with the first faults are
/// only rejected if few have them (may_leave_out). All samples pass if the record's arrays differ in length. O(N log
/// N).
std::vector<bool> find_inliers(const sim::ImuRecord& record);

/// Converts the samples of an IMU, in order, and drops single faulty readings (find_inliers). Errors: `empty`,
/// `non_finite`, `time_order`, `gap` (more than kGapMaxS), `out_of_range` (check_range, or a median step that differs
/// 20-fold from the stated period). On error, `out` is empty. Throws BadInput if the record's arrays differ in length.
/// O(N).
Status imu_samples(const sim::ImuRecord& record, std::vector<ImuSample>& out);

/// Converts the primary IMU's samples; returns `empty` if the recording has no IMU.
Status primary_imu_samples(const sim::Sensors& sensors, std::vector<ImuSample>& out);

/// Converts the samples of the IMU with the true, unsaturated readings of `truth`. Throws BadInput if `truth` does not
/// belong to the record.
Status unclipped_samples(const sim::ImuRecord& record, const sim::ImuTruth& truth, std::vector<ImuSample>& out);

/// Returns the vector from the centre of mass to the IMU, in IMU axes [m]: R_BI^T p_BI of the calibration.
Eigen::Vector3d lever_arm_I_m(const sim::ImuRecord& record);

/// Returns the transform from lidar to IMU coordinates, from the two calibrations.
Eigen::Isometry3d T_IL(const sim::ImuRecord& imu, const sim::LidarRecord& lidar);

/// Returns the variance of one gyro reading per axis [(rad/s)^2], from the noise density of the data sheet and the
/// sample period.
double gyro_variance_rad2_s2(const sim::ImuRecord& record);

/// One lidar sweep in the estimator's message format.
struct Sweep {
  std::int64_t start_ns = 0;
  std::int64_t end_ns = 0;
  std::vector<LidarPoint> points;
};

/// Returns the number of sweeps. Throws BadInput if the record's arrays are inconsistent.
std::size_t sweep_count(const sim::LidarRecord& record);

/// Tolerance for rounded stamps [ns]. Stamps that are stored as seconds since 1970 in a double are rounded by up to a
/// quarter of this tolerance.
inline constexpr std::int64_t kRounding_ns = 1000;

/// Converts the sweep with number `index`, which must be less than sweep_count(record). The sweep lasts one period, or
/// until the next sweep starts if the next sweep starts earlier. Points that are later than the sweep's end by more
/// than kRounding_ns are dropped; points within the tolerance are moved to the end. Without a time per point, the sweep
/// has zero length and is not deskewed. The cost is proportional to the number of points of the sweep.
Sweep sweep(const sim::LidarRecord& record, std::size_t index);

}  // namespace tumble::scenarios::bridge
