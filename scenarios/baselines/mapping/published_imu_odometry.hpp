// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <span>
#include <utility>
#include <vector>

#include "tumble/angular_velocity/rate_state.hpp"
#include "tumble/common/imu.hpp"

namespace tumble::baselines {

/// Attitude by Madgwick's filter and position by the accelerometer, in a frame of its own ("odom"): what the published
/// chain (PublishedChain) deskews by and starts its registration from. Not moved until a velocity was fed back.
class PublishedImuOdometry {
 public:
  /// `rates`, one for each sample, take the place of what the gyro reads. `samples` must outlive it.
  PublishedImuOdometry(double madgwick_gain_rad_s, std::span<const ImuSample> samples,
                       std::span<const RateState> rates);

  /// Integrates up to the sample at or after `to_ns`.
  void advance(TimeNs to_ns);
  /// Velocity by registration, valid at `time_ns`: what the accelerometer has added since is added again.
  void feed_back(const Eigen::Vector3d& velocity_m_s, TimeNs time_ns);

  /// Pose of the IMU, linear and slerp between samples, constant before the first.
  Eigen::Isometry3d pose(TimeNs time_ns) const;
  /// As it was believed when the sample was integrated, nearest at or after the time.
  const Eigen::Vector3d& velocity_m_s(TimeNs time_ns) const;

 private:
  /// The first of the samples integrated so far at or after the time; of later times the last.
  std::size_t sample_at(TimeNs time_ns) const;
  Eigen::Vector3d acceleration_m_s2(std::size_t k) const;

  std::span<const ImuSample> samples_;
  std::vector<Eigen::Quaterniond> attitude_;
  std::vector<Eigen::Vector3d> p_m_, v_m_s_;  // of the samples integrated so far
  std::vector<std::pair<TimeNs, Eigen::Vector3d>> changes_;
  Eigen::Vector3d velocity_m_s_ = Eigen::Vector3d::Zero();
  double gravity_m_s2_ = 0.0;
  bool fed_back_ = false;
};

}  // namespace tumble::baselines
