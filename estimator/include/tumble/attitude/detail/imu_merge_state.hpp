// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "tumble/attitude/detail/force_errors.hpp"
#include "tumble/attitude/detail/imu_merge_setup.hpp"
#include "tumble/attitude/detail/multi_imu_sign_check.hpp"
#include "tumble/attitude/detail/rate_recovery.hpp"
#include "tumble/common/detail/imu_average.hpp"
#include "tumble/common/types.hpp"

namespace tumble {

/// Run of equal readings of one IMU, with the readings of the other IMUs at the start of the run, and the rotation
/// since then.
struct RepeatedImuReading {
  Eigen::Vector3d repeated_reading = Eigen::Vector3d::Zero(), other_imus_reading = Eigen::Vector3d::Zero();
  Eigen::Vector3d turned_rad = Eigen::Vector3d::Zero();
  TimeNs since_ns = 0;
  double repeated_s = 0.0;
  bool operator==(const RepeatedImuReading&) const = default;
};

/// Errors of one IMU relative to the mean of all IMUs.
struct MergedImuState {
  static constexpr int kErrorCount = 13;  ///< bias, scale and misalignment, time offset

  Eigen::Matrix<double, kErrorCount, 1> x = Eigen::Matrix<double, kErrorCount, 1>::Zero();
  Eigen::Matrix<double, kErrorCount, kErrorCount> covariance = Eigen::Matrix<double, kErrorCount, kErrorCount>::Zero();
  ImuAverage window;
  /// mean rate and specific force over the last window; predicted from the other IMUs if the IMU is excluded
  Eigen::Vector3d last_rate_rad_s = Eigen::Vector3d::Zero(), last_force_m_s2 = Eigen::Vector3d::Zero();
  double exclusion_left_s = 0.0;  ///< remaining time of exclusion from the mean specific force
  std::int64_t excluded_window_count = 0;
  RepeatedImuReading repeated_rate, repeated_force;
  double changing_readings_duration_s = 0.0;
  double rate_difference_to_others_rad_s = 0.0, force_disagreement_m_s2 = 0.0, disagreement_s = 0.0;
  TimeNs disagreement_since_ns = 0;
  bool is_frozen = false, disagrees = false;
  std::int64_t missing_samples = 0;
  TimeNs frozen_since_ns = 0, disagrees_since_ns = 0, missing_since_ns = 0;
  bool is_excluded() const { return is_frozen || disagrees; }
  double offset_s() const { return x[kErrorCount - 1]; }
  bool operator==(const MergedImuState&) const = default;
};

struct ImuMergeState {
  static constexpr int kImus = ImuMergeSetup::kImus;
  static constexpr int kAngularAccelerationWindows = 3;

  std::array<MergedImuState, kImus> imus{};
  ForceErrors::State forces;
  AngularRateRecovery::State rate_recovery;
  Eigen::Vector3d rate_rad_s = Eigen::Vector3d::Zero();           ///< fused rate over the last window
  Eigen::Vector3d previous_rate_rad_s = Eigen::Vector3d::Zero();  ///< fused rate over the window before
  double rotation_rate_rad_s = 0.0;                               ///< mean magnitude of the rate over half a second
  double window_s = 0.0;
  double length_s = 0.0, previous_length_s = 0.0;
  double lever_arm_correlation = 0.0, lever_arm_effect_power = 0.0;  ///< sums for lever_arm_agreement()
  MultiImuSignCheck imu_sign_check;
  std::int64_t sample_count = 0, window_count = 0;
  int unclipped_windows = kAngularAccelerationWindows;  ///< windows since a gyro clipped or an IMU was absent
  TimeNs last_time_ns = 0;
  bool all_frozen = false;
  bool operator==(const ImuMergeState&) const = default;
};

}  // namespace tumble
