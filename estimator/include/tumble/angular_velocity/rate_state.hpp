// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "tumble/common/time.hpp"

namespace tumble {

/// Source of an angular velocity.
enum class RateSource : std::uint8_t {
  measured,           ///< no gyro axis is clipped or suspect
  recovered_flight,   ///< clipped; recovered from the centripetal specific force in free flight
  recovered_contact,  ///< clipped; recovered from the force during contact
  bounded_only,       ///< clipped or suspect; only a lower bound and smoothness of motion are known
};

/// Returns the name of a rate source as used in tables ("recovered_flight").
const char* to_string(RateSource source);

/// RateState contains the angular velocity of an IMU in the world, in the IMU's axes, at the time of an IMU sample.
struct RateState {
  TimeNs time_ns = 0;
  Eigen::Vector3d w_WI_I_rad_s = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance_rad2_s2 = Eigen::Matrix3d::Zero();
  std::uint8_t clipped_axes = 0;  ///< bit j set: gyro axis j was saturated
  RateSource source = RateSource::measured;
};

}  // namespace tumble
