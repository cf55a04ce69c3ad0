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

/// The one place where the records of `sim` become the messages of the estimator. Both libraries state their
/// conventions by themselves; here they are compared, field by field:
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

/// Longest time between two IMU samples that a recording may have [s].
inline constexpr double kGapMaxS = 1.0;

/// Readings up to so many stated ranges are taken for measurements: rails lie beyond what a sheet states (of the MTi-30
/// at 1.4 times), and tilted ones in each axis anew. What reads further was never measured.
inline constexpr double kStatedRangesMax = OutlierFilter::kRangesMax;

/// A recording of which a larger share lies further is refused: that is another unit, or another device.
inline constexpr double kWildShareMax = 0.01;

/// `out_of_range` for the first axis of a reading, in its own axes, beyond kStatedRangesMax times the range that the
/// record states, with value and bound; a stated range of 0 says nothing.
Status check_range(const sim::ImuRecord& record, const Eigen::Vector3d& gyro_rad_s, const Eigen::Vector3d& accel_m_s2);

/// Judges the samples of an IMU with the library's OutlierFilter. Element k is true if sample k passes. All pass if a
/// reading is not finite, if a stamp does not rise, or if the record's arrays differ in length. O(N).
std::vector<bool> find_inliers(const sim::ImuRecord& record);

/// Samples of an IMU, in order, without single wild readings beyond kStatedRangesMax (find_inliers), if these are few.
/// Trouble: `empty`, `non_finite`, `time_order`, `gap` (more than kGapMaxS), `out_of_range` (check_range of other
/// readings; a median step 20 times off the stated period); then `out` is empty. Throws BadInput when the record's
/// arrays differ in length. O(N).
Status imu_samples(const sim::ImuRecord& record, std::vector<ImuSample>& out);

/// The primary IMU's samples; `empty` when the recording has no IMU.
Status primary_imu_samples(const sim::Sensors& sensors, std::vector<ImuSample>& out);

/// The same samples with the rail taken away, from the truth's twin of the record. Throws BadInput when the truth does
/// not belong to the record.
Status unclipped_samples(const sim::ImuRecord& record, const sim::ImuTruth& truth, std::vector<ImuSample>& out);

/// From the centre of mass to the IMU, in IMU axes [m]: R_BI^T p_BI of the calibration.
Eigen::Vector3d lever_arm_I_m(const sim::ImuRecord& record);

/// Lidar coordinates to IMU coordinates, from the two calibrations.
Eigen::Isometry3d T_IL(const sim::ImuRecord& imu, const sim::LidarRecord& lidar);

/// Variance of one reading of the gyro per axis, from the data sheet's density and the sample's length [(rad/s)^2].
double gyro_variance_rad2_s2(const sim::ImuRecord& record);

/// One sweep of a lidar as the estimator takes it.
struct Sweep {
  std::int64_t start_ns = 0;
  std::int64_t end_ns = 0;
  std::vector<LidarPoint> points;
};

/// Number of sweeps. Throws BadInput when the record's arrays do not fit together.
std::size_t sweep_count(const sim::LidarRecord& record);

/// Stamps of seconds in double since 1970 are rounded to a quarter of this [ns].
inline constexpr std::int64_t kRounding_ns = 1000;

/// Sweep `index` < sweep_count(record): it lasts for the period, or until the next begins where that is sooner, since
/// sweeps of a real lidar do not follow each other to the nanosecond. Points later than that by more than kRounding_ns
/// are left out, others belong to the end. Where the points have no times of their own the sweep has no length: all
/// belong to its start, and there is nothing to deskew. O(points of the sweep).
Sweep sweep(const sim::LidarRecord& record, std::size_t index);

}  // namespace tumble::scenarios::bridge
