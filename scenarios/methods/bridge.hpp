// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "sim/recording.hpp"
#include "tumble/angular_velocity/types.hpp"
#include "tumble/common/detail/outlier_filter.hpp"
#include "tumble/common/status.hpp"
#include "tumble/common/types.hpp"
#include "tumble/mapping/types.hpp"
#include "tumble/odometry/sensor_sheets.hpp"

/// The libraries `sim` and `estimator` have these conventions:
///
/// - In both libraries, the time of a sample is the end of its averaging window [ns].
/// - In both libraries, the rate is the rate of the IMU relative to the world, in IMU axes [rad/s].
/// - In both libraries, the specific force is in IMU axes [m/s^2], with +g upward at rest.
/// - In both libraries, a lidar point is in metres in the lidar frame, with its time offset from the sweep start [ns].
/// - The clip flags are bits 0 to 5 (gyro x y z, accelerometer x y z) in `sim`, and the type ClipFlag in `estimator`.
/// - The IMU mounting is T_BI (body frame B at the centre of mass) in `sim`, and the lever arm from the centre of mass
///   to the IMU (in IMU axes) in `estimator`.
/// - The lidar pose is relative to the body (T_BL) in `sim`, and relative to the IMU (T_IL) in `estimator`.
namespace tumble::scenarios::bridge {

inline constexpr double kGapMaxS = 1.0, kAnyGapS = std::numeric_limits<double>::infinity();

/// Maximum ratio of a reading to the stated range of a device. The saturation limit of a real device may exceed its
/// stated range (MTi-30: by a factor of 1.4). If the saturation limit of one output also depends on the other two
/// outputs (tilted limit), this output may exceed the stated range by a larger factor.
inline constexpr double kStatedRangesMax = OutlierFilter::kMaxReadingToRangeRatio;

inline constexpr double kWildShareMax = 0.01;

ImuDataSheet imu_sheet(const sim::ImuRecord& record);

Status check_range(const sim::ImuRecord& record, const Eigen::Vector3d& gyro_rad_s, const Eigen::Vector3d& accel_m_s2);

/// A usable IMU sample is finite, in order of time, and accepted by OutlierFilter. If unusable samples are frequent, or
/// the arrays of the record differ in length, all samples count as usable.
std::vector<bool> find_inliers(const sim::ImuRecord& record);

/// Returns the error `empty`, `non_finite`, `time_order`, `gap` or `out_of_range` if the estimator cannot use the IMU
/// record. The code `out_of_range` means a reading far beyond the device's range, or a median time step that differs
/// 20-fold from the stated sample period. On error, `out` is empty.
Status imu_samples(const sim::ImuRecord& record, std::vector<ImuSample>& out, double gap_max_s = kGapMaxS);

/// All samples of an IMU record, with the times at which they reach the estimator. A sample with a faulty time stamp
/// arrives with the sample before.
struct DeliveredSamples {
  std::vector<ImuSample> samples;
  std::vector<TimeNs> arrival_ns;
};

/// Returns all samples if imu_samples() returns `ok`, and otherwise its error. An online estimator cannot leave out
/// samples because of later samples, so the estimator itself must reject faulty samples.
Status delivered_samples(const sim::ImuRecord& record, DeliveredSamples& out);

Status primary_imu_samples(const sim::Sensors& sensors, std::vector<ImuSample>& out, double gap_max_s = kGapMaxS);

Status unclipped_samples(const sim::ImuRecord& record, const sim::ImuTruth& truth, std::vector<ImuSample>& out);

/// Vector from the centre of mass to the IMU, in IMU axes [m].
Eigen::Vector3d lever_arm_I_m(const sim::ImuRecord& record);

Eigen::Isometry3d T_IL(const sim::ImuRecord& imu, const sim::LidarRecord& lidar);

/// Variance of one gyro reading per axis [(rad/s)^2], from the noise density of the data sheet and the sample period.
double gyro_variance_rad2_s2(const sim::ImuRecord& record);

struct Sweep {
  std::int64_t start_ns = 0;
  std::int64_t end_ns = 0;
  std::vector<LidarPoint> points;
};

std::size_t sweep_count(const sim::LidarRecord& record);

/// Time stamps that are stored as seconds since 1970 in a double have rounding errors of up to 250 ns.
inline constexpr std::int64_t kRounding_ns = 1000;

/// A lidar sweep ends after one period or at the start of the next sweep, whichever is earlier. Points up to
/// kRounding_ns after the end of the sweep get the time of the end; later points are dropped. A sweep without a time
/// per point has zero duration, so its points are not deskewed.
Sweep sweep(const sim::LidarRecord& record, std::size_t index);

}  // namespace tumble::scenarios::bridge
