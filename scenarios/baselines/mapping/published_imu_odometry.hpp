// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <span>
#include <utility>
#include <vector>

#include "tumble/angular_velocity/types.hpp"
#include "tumble/common/types.hpp"

namespace tumble::baselines {

class PublishedImuOdometry {
 public:
  /// The caller must keep the data of `samples` alive as long as the PublishedImuOdometry.
  PublishedImuOdometry(double madgwick_gain_rad_s, std::span<const ImuSample> samples,
                       std::span<const AngularRateState> rates);

  void advance(TimeNs to_ns);
  /// Replaces the velocity at `time_ns` by the velocity from lidar registration, and integrates the later accelerometer
  /// samples again.
  void feed_back(const Eigen::Vector3d& velocity_m_s, TimeNs time_ns);

  Eigen::Isometry3d pose(TimeNs time_ns) const;
  const Eigen::Vector3d& velocity_m_s(TimeNs time_ns) const;

 private:
  std::size_t sample_at(TimeNs time_ns) const;
  Eigen::Vector3d acceleration_m_s2(std::size_t k) const;

  std::span<const ImuSample> samples_;
  std::vector<Eigen::Quaterniond> attitude_;
  std::vector<Eigen::Vector3d> p_m_, v_m_s_;  // positions and velocities at the integrated samples
  std::vector<std::pair<TimeNs, Eigen::Vector3d>> changes_;
  Eigen::Vector3d velocity_m_s_ = Eigen::Vector3d::Zero();
  double gravity_m_s2_ = 0.0;
  bool fed_back_ = false;
};

}  // namespace tumble::baselines
