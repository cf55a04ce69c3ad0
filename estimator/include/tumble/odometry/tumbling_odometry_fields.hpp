// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tumble/mapping/lidar_inertial_odometry_fields.hpp"
#include "tumble/odometry/tumbling_odometry.hpp"

namespace tumble {

template <class Self, class Visitor>
void TumblingOdometry::Params::fields(Self& p, Visitor& visit) {
  visit.group("imu_", p.imu);
  visit(p.lever_arm_I_m,
        {"lever_arm_m", "m", -10.0, 10.0, "from the centre of mass to the IMU, IMU axes", Rank::first});
  visit(p.lever_arm_sigma_m, {"lever_arm_sigma_m", "m", 1e-9, 10.0, "what the lever arm may be off by", Rank::first});
  visit(p.mount_sigma_rad,
        {"mount_sigma_rad", "rad", 0.0, 1.0, "the lidar's attitude on the IMU as given; 0: exact", Rank::first});
  visit(p.mount_sigma_m,
        {"mount_sigma_m", "m", 0.0, 1.0, "the lidar's position on the IMU as given; 0: exact", Rank::first});
  visit(p.time_offset_sigma_s,
        {"time_offset_sigma_s", "s", 0.0, 0.02, "offset between the clocks of lidar and IMU; 0: none", Rank::first});
  visit.group("", p.lidar);
  visit(p.gravity_m_s2, {"gravity_m_s2", "m/s^2", 0.0, 100.0, "strength of gravity", Rank::first});
  visit(p.lag_s, {"lag_s", "s", 0.0, 10.0, "how old a sample is when its rate is settled", Rank::first});
  visit(p.sweeps_max, {"sweeps_max", "1", 1, 1e6, "sweeps that may wait for the IMU"});
  visit.group("rate_", p.expert.rate);
  visit.group("mapping_", p.expert.mapping);
  visit.group("again_", p.expert.again);
}

}  // namespace tumble
