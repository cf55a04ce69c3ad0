// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <string>
#include <vector>

#include "sim/sensors.hpp"

namespace tumble::sim {

enum class ContactLabel : std::uint8_t { air, grip, slip, slide };

struct ContactTruth {
  std::int64_t time_ns = 0;
  Eigen::Vector3d point_W_m;
  Eigen::Vector3d normal_W;  ///< unit vector, into the robot
  /// tangential velocity of the robot's surface at the contact point, relative to the world
  Eigen::Vector3d slip_velocity_W_m_s;
  double normal_force_n = 0;
  std::int32_t surface_id = -1;
};

/// ImuTruth contains the true motion and the sensor errors of each IMU reading.
struct ImuTruth {
  std::string name;
  Eigen::Isometry3d T_BI = Eigen::Isometry3d::Identity();  ///< true mounting
  std::vector<Eigen::Vector3d> rate_rad_s;            ///< rotation over the averaging window, divided by its duration
  std::vector<Eigen::Vector3d> specific_force_m_s2;   ///< mean over the window, in axes halfway through the rotation
  std::vector<Eigen::Vector3d> gyro_unclipped_rad_s;  ///< readings with all errors except saturation
  std::vector<Eigen::Vector3d> accel_unclipped_m_s2;
  std::vector<Eigen::Vector3d> gyro_bias_rad_s;
  std::vector<Eigen::Vector3d> accel_bias_m_s2;
  /// Directions of the three sensing elements, which are the rows of the misalignment matrix M (sim/imu/elements.hpp).
  /// The list is empty if the sensing elements are aligned with the output axes.
  std::vector<Eigen::Vector3d> gyro_elements, accel_elements;
  Eigen::Vector3d gyro_element_offset_rad_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d accel_element_offset_m_s2 = Eigen::Vector3d::Zero();
  std::vector<Eigen::Vector3d> magnetic_field_t;  ///< true mean over the window, including disturbances
};

struct LidarTruth {
  std::string name;
  Eigen::Isometry3d T_BL = Eigen::Isometry3d::Identity();
  std::vector<Eigen::Vector3f> hit_W_m;
  std::vector<std::int32_t> surface_id;  ///< index in Truth::surfaces; -2: cage of the robot
};

struct QuantityTruth {
  std::string name;
  std::string unit;
  std::vector<double> values;  ///< true means over the averaging windows
};

struct SeriesTruth {
  std::string name;
  Eigen::Isometry3d T_BX = Eigen::Isometry3d::Identity();  ///< true mounting
  std::vector<QuantityTruth> quantities;
};

struct Truth {
  std::int64_t period_ns = 500000;
  std::vector<Eigen::Vector3d> p_WB_m;
  std::vector<Eigen::Quaterniond> q_WB;
  std::vector<Eigen::Vector3d> v_WB_m_s;
  std::vector<Eigen::Vector3d> w_WB_B_rad_s;
  std::vector<Eigen::Vector3d> f_B_m_s2;  ///< mean specific force of the centre of mass over a step
  std::vector<ContactLabel> label;
  std::vector<ContactTruth> contacts;
  Eigen::Vector3d p_BG_m = Eigen::Vector3d::Zero();  ///< geometric centre of a sphere, in body axes
  std::vector<std::string> surfaces;                 ///< name of surface id i: "terrain", "rock_3", "trunk_7"
  std::vector<ImuTruth> imus;                        ///< in the order of Sensors::imus
  std::vector<LidarTruth> lidars;
  std::vector<SeriesTruth> series;  ///< in the order of Sensors::series
};

struct Recording {
  Sensors sensors;
  Truth truth;
};

}  // namespace tumble::sim
