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

/// Rates that a rail hid and a smoother of the rate recovered, for methods that take them as readings.
namespace tumble::scenarios {

struct RecoveredRates {
  std::vector<Eigen::Matrix3d> covariances_rad2_s2;  ///< one per sample, sensor axes; zero of those that are as read
  std::vector<RateSource> sources;                   ///< one per sample, of rate/tumble; all `measured` without it
  bool answered = false;                             ///< a reading clips, and rate/tumble has an answer
  CarriedBody carried;                               ///< of rate/tumble
};

/// Puts what rate/tumble says in place of readings that the rail made wrong, all three axes of them: while one clips, a
/// tilted rail spoils those beside it too. The gyro's bias stays in: it is the mean difference where nothing clips.
/// Where no reading clips, or the smoother has no answer, the samples stay as they are. `samples`: those of the primary
/// IMU.
RecoveredRates recover_clipped(const sim::Sensors& sensors, std::vector<ImuSample>& samples,
                               std::map<std::string, double>& health);

/// The same of readings that it doubts as well (a smoother that bounds the motion by itself errs less with those as
/// they stand), and where the gyro is slower than its log, so that its readings tell of what was, what they tell of
/// each sample's own time; beside those that clip, all of it is rate/tumble's.
RecoveredRates recover_in_time(const sim::Sensors& sensors, std::vector<ImuSample>& samples,
                               std::map<std::string, double>& health);

}  // namespace tumble::scenarios
