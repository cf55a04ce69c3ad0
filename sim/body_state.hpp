// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace tumble::sim {

struct BodyState {
  double time_s = 0.0;
  Eigen::Vector3d p_WB_m = Eigen::Vector3d::Zero();
  Eigen::Quaterniond q_WB = Eigen::Quaterniond::Identity();
  Eigen::Vector3d v_WB_m_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d w_WB_B_rad_s = Eigen::Vector3d::Zero();
};

struct Wrench {
  Eigen::Vector3d force_W_n = Eigen::Vector3d::Zero();
  Eigen::Vector3d torque_W_nm = Eigen::Vector3d::Zero();
};

}  // namespace tumble::sim
