// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "sim/recording.hpp"
#include "tumble/angular_velocity/rate_state.hpp"
#include "tumble/common/imu.hpp"
#include "tumble/common/outlier_filter.hpp"
#include "tumble/common/status.hpp"
#include "tumble/mapping/lidar.hpp"

/// Converts the records of `sim` to the messages of the estimator. This is the only conversion. Each library states its
/// conventions separately; this table compares them:
///
/// | quantity       | sim                                        | estimator                                      |
/// | -------------- | ------------------------------------------ | ---------------------------------------------- |
/// | time           | ns, end of the sample's window             | ns, the window ends there                      |
/// | rate           | rad/s, of I in W, I axes                   | w_WI_I, rad/s                                  |
/// | specific force | m/s^2, I axes, +g up at rest               | f_I, the same sign                             |
/// | clip flags     | bits 0..5: gyro x y z, accel x y z         | ClipFlag                                       |
/// | mounting       | T_BI, T_BL: sensor to body, B at the centre of mass | lever arm in I axes from it; T_IL     |
/// | lidar point    | m in L, offset ns after the sweep's start  | the same, one struct per point                 |
namespace tumble::scenarios::bridge {

/// Longest accepted time between two IMU samples [s].
inline constexpr double kGapMaxS = 1.0;

/// Readings up to this multiple of the stated range are accepted as measurements. Real saturation limits exceed the
/// stated range (MTi-30: 1.4 times), and tilted limits more so. Larger readings cannot be measurements.
inline constexpr double kStatedRangesMax = OutlierFilter::kRangesMax;

/// A recording with a larger share of such readings is refused: its unit or its device must be another one.
inline constexpr double kWildShareMax = 0.01;

/// Returns `out_of_range`, with value and bound, for the first axis whose reading exceeds kStatedRangesMax times the
/// range in the record. A stated range of 0 disables the check.
Status check_range(const sim::ImuRecord& record, const Eigen::Vector3d& gyro_rad_s, const Eigen::Vector3d& accel_m_s2);

/// Judges the samples of an IMU with the library's OutlierFilter. Element k is true if sample k passes. All pass if a
/// reading is not finite, if a stamp does not rise, or if the record's arrays differ in length. O(N).
std::vector<bool> find_inliers(const sim::ImuRecord& record);

/// Converts the samples of an IMU, in order, without a few single readings beyond kStatedRangesMax (find_inliers).
/// Errors: `empty`, `non_finite`, `time_order`, `gap` (more than kGapMaxS), `out_of_range` (check_range, or a median
/// step that differs 20-fold from the stated period); `out` is then empty. Throws BadInput if the record's arrays
/// differ in length. O(N).
Status imu_samples(const sim::ImuRecord& record, std::vector<ImuSample>& out);

/// Converts the primary IMU's samples; returns `empty` if the recording has no IMU.
Status primary_imu_samples(const sim::Sensors& sensors, std::vector<ImuSample>& out);

/// Converts the same samples without saturation, from the ground truth of the record. Throws BadInput if the truth does
/// not belong to the record.
Status unclipped_samples(const sim::ImuRecord& record, const sim::ImuTruth& truth, std::vector<ImuSample>& out);

/// Returns the vector from the centre of mass to the IMU, in IMU axes [m]: R_BI^T p_BI of the calibration.
Eigen::Vector3d lever_arm_I_m(const sim::ImuRecord& record);

/// Returns the transform from lidar to IMU coordinates, from the two calibrations.
Eigen::Isometry3d T_IL(const sim::ImuRecord& imu, const sim::LidarRecord& lidar);

/// Returns the variance of one gyro reading per axis [(rad/s)^2], from the data sheet's noise density and the sample
/// period.
double gyro_variance_rad2_s2(const sim::ImuRecord& record);

/// One lidar sweep in the estimator's format.
struct Sweep {
  std::int64_t start_ns = 0;
  std::int64_t end_ns = 0;
  std::vector<LidarPoint> points;
};

/// Returns the number of sweeps. Throws BadInput if the record's arrays are inconsistent.
std::size_t sweep_count(const sim::LidarRecord& record);

/// Tolerance for rounded stamps [ns]. Stamps stored as seconds since 1970 in a double are rounded to a quarter of this.
inline constexpr std::int64_t kRounding_ns = 1000;

/// Converts sweep `index` < sweep_count(record). The sweep lasts one period, or until the next sweep starts if that is
/// sooner. Points later than the end by more than kRounding_ns are dropped; points within that tolerance are clamped to
/// the end. Without per-point times the sweep has zero length and is not deskewed. O(points of the sweep).
Sweep sweep(const sim::LidarRecord& record, std::size_t index);

}  // namespace tumble::scenarios::bridge
