// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "tumble/common/time.hpp"

namespace tumble {

enum class AngularRateSource : std::uint8_t {
  measured,              ///< no gyro axis is clipped or suspect
  recovered_in_flight,   ///< clipped; recovered from the centripetal force in free flight
  recovered_in_contact,  ///< clipped; recovered from the specific force during contact
  lower_bound_only,      ///< clipped or suspect; limited only by a lower bound and by smooth motion
};

const char* to_string(AngularRateSource source);

/// Angular velocity of an IMU relative to the world, in IMU axes, at the time of an IMU sample.
struct AngularRateState {
  TimeNs time_ns = 0;
  Eigen::Vector3d w_WI_I_rad_s = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance_rad2_s2 = Eigen::Matrix3d::Zero();
  std::uint8_t clipped_axes = 0;  ///< bit j: gyro axis j was saturated
  AngularRateSource source = AngularRateSource::measured;
};

}  // namespace tumble
