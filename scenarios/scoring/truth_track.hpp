// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "scenarios/estimates/method.hpp"
#include "sim/recording.hpp"

namespace tumble::scenarios {

/// TruthTrack is the true motion of one frame of the robot at any time of the recording. Between physics samples (0.5
/// ms apart), position is interpolated linearly and attitude by slerp. At 400 m/s^2 and 25 rad/s, the interpolation
/// error is below 13 um and 1 urad.
class TruthTrack {
 public:
  /// The body counts as at rest at a time t if speed and rate are below kRestSpeedMS and kRestRateRadS from t -
  /// kRestWindowS to t + kRestWindowS.
  static constexpr double kRestWindowS = 0.1;
  static constexpr double kRestSpeedMS = 0.03;
  static constexpr double kRestRateRadS = 0.05;

  TruthTrack(const sim::Truth& truth, Frame frame);

  std::int64_t last_ns() const { return last_ns_; }
  bool covers(std::int64_t time_ns) const;
  bool covers_attitude(std::int64_t time_ns) const;

  /// Returns pose and velocity of the frame `frame` (constructor argument) in the world; NaN at times with unknown
  /// position.
  PoseState pose(std::int64_t time_ns) const;
  /// Returns the rate of the frame `frame` (constructor argument) in the axes of this frame [rad/s]; NaN at times with
  /// unknown rate.
  Eigen::Vector3d rate_rad_s(std::int64_t time_ns) const;
  /// Returns the path length of the frame `frame` (constructor argument) since time 0 [m]. The pose at `time_ns` must
  /// be known.
  double path_m(std::int64_t time_ns) const;
  bool at_rest(std::int64_t time_ns) const;

 private:
  struct Between {
    std::size_t index = 0, next = 0;
    double share = 0.0;
  };
  Between between(std::int64_t time_ns) const;
  Eigen::Vector3d body_rate_rad_s(std::int64_t time_ns) const;
  bool known(std::size_t index) const;
  bool attitude_known(std::size_t index) const;
  Eigen::Vector3d position(std::size_t index) const;

  const sim::Truth* truth_;
  Eigen::Isometry3d T_BA_ = Eigen::Isometry3d::Identity();
  std::int64_t last_ns_ = 0;
  std::vector<double> path_m_;
  std::vector<bool> rest_;
};

struct PairedPose {
  std::int64_t time_ns = 0;
  PoseState estimate;
  PoseState truth;
  double path_m = 0;  ///< true path length since time 0
};

/// Alignment transforms an estimate from its own world frame to the true world frame, by position and heading only.
/// Gravity determines roll and pitch, so an initial tilt error counts as an error.
struct Alignment {
  double yaw_rad = 0;
  Eigen::Vector3d translation_m = Eigen::Vector3d::Zero();

  static Alignment at(const PoseState& estimate, const PoseState& truth);
  Eigen::Isometry3d transform() const;
  PoseState apply(const PoseState& pose) const;
};

double twist_about_z_rad(const Eigen::Quaterniond& q);

/// Returns the angle of a rotation in [0, pi], with high accuracy for angles near 0 and near pi.
double rotation_angle_rad(const Eigen::Quaterniond& q);

/// Returns the horizontal part of the attitude error phi, in the world frame of the estimate. The attitude error
/// satisfies q_true = Exp(phi) q_estimate, after the heading of `q_true` is aligned with the heading of `q_estimate`.
Eigen::Vector2d tilt_error_rad(const Eigen::Quaterniond& q_estimate, const Eigen::Quaterniond& q_true);

struct PairedTrack {
  Alignment alignment;
  std::vector<PairedPose> poses;
};
PairedTrack pair_poses(const Estimate& estimate, const TruthTrack& truth);

}  // namespace tumble::scenarios
