// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <map>
#include <string>
#include <vector>

#include "scenarios/methods/rate_regimes.hpp"
#include "sim/recording.hpp"
#include "tumble/angular_velocity/rate_state.hpp"
#include "tumble/common/imu.hpp"

/// Replaces clipped gyro readings by rates of rate/tumble, for methods that process gyro readings.
namespace tumble::scenarios {

struct RecoveredRates {
  std::vector<Eigen::Matrix3d> covariances_rad2_s2;  ///< one per sample, sensor axes; zero for unmodified readings
  std::vector<RateSource> sources;                   ///< one per sample; all `measured` if rate/tumble did not run
  bool answered = false;                             ///< a reading clips, and rate/tumble succeeded
  CarriedBody carried;                               ///< from rate/tumble
};

/// Replaces all three axes of clipped samples by the rates of rate/tumble, because a tilted saturation plane also
/// corrupts the unclipped axes. The function adds the gyro bias to the recovered rates, estimated as the mean
/// difference of unclipped samples. The samples are unchanged if no reading clips or if the smoother fails. `samples`
/// are the samples of the primary IMU.
RecoveredRates recover_clipped(const sim::Sensors& sensors, std::vector<ImuSample>& samples,
                               std::map<std::string, double>& health);

/// Replaces clipped readings, and readings that rate/tumble marks as suspect. If the gyro's response is slower than its
/// output rate, all readings are replaced, because rate/tumble removes the gyro's delay. Smoothers with their own
/// motion limits should not use this function, because they perform better with the original suspect readings.
RecoveredRates recover_in_time(const sim::Sensors& sensors, std::vector<ImuSample>& samples,
                               std::map<std::string, double>& health);

}  // namespace tumble::scenarios
