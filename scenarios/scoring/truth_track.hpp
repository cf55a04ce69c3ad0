// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "scenarios/methods/method.hpp"
#include "sim/recording.hpp"

namespace tumble::scenarios {

/// The true motion of one frame of the robot, at any instant of the recording.
///
/// Position is interpolated linearly and attitude by slerp between physics samples (0.5 ms: at 400 m/s^2 and 25 rad/s
/// the error is below 13 um and 1 urad). The frame is a true mounting: calibration errors of the estimator count as
/// errors.
class TruthTrack {
 public:
  /// Rest: everywhere within this time around the instant the body moves slower than both bounds; than that of the rate
  /// where the truth knows no position at all.
  static constexpr double kRestWindowS = 0.1;
  static constexpr double kRestSpeedMS = 0.03;
  static constexpr double kRestRateRadS = 0.05;

  /// Throws BadInput when the truth's arrays differ in length, are empty, or the frame's sensor is not in it.
  /// O(number of physics samples).
  TruthTrack(const sim::Truth& truth, Frame frame);

  std::int64_t last_ns() const { return last_ns_; }
  /// Within the truth, and where it is known: a reference has gaps.
  bool covers(std::int64_t time_ns) const;
  /// The same where the attitude is known, whether or not the position is.
  bool covers_attitude(std::int64_t time_ns) const;

  /// Pose of the frame in W and velocity of its origin, NaN where position is not known; the attitude at `time_ns` must
  /// be covered. O(1).
  PoseState pose(std::int64_t time_ns) const;
  /// Turning rate of the frame in W, its own axes [rad/s]; `time_ns` must be covered. NaN where the truth does not know
  /// it. O(1).
  Eigen::Vector3d rate_rad_s(std::int64_t time_ns) const;
  /// Length of the way that the frame's origin has gone since time 0 [m]; `time_ns` must be covered.
  double path_m(std::int64_t time_ns) const;
  /// Whether the body stands still around the instant; `time_ns` must be covered.
  bool at_rest(std::int64_t time_ns) const;

 private:
  /// The samples around an instant, and how far from the first to the second it lies.
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

/// One instant of an estimate beside the truth, both in W, the estimate aligned.
struct PairedPose {
  std::int64_t time_ns = 0;
  PoseState estimate;
  PoseState truth;
  double path_m = 0;  ///< gone by the truth since time 0
  bool rest = false;
};

/// The transform that a world of the estimator's own needs: four degrees of freedom, since gravity is not the
/// estimator's to choose. A tilted start stays an error.
struct Alignment {
  double yaw_rad = 0;
  Eigen::Vector3d translation_m = Eigen::Vector3d::Zero();

  /// Takes `estimate` to the position and the heading of `truth`.
  static Alignment at(const PoseState& estimate, const PoseState& truth);
  Eigen::Isometry3d transform() const;
  PoseState apply(const PoseState& pose) const;
};

/// Heading of a rotation: the angle of its twist about z, in (-pi, pi].
double twist_about_z_rad(const Eigen::Quaterniond& q);

/// Angle of a rotation in [0, pi], exact for small angles and near a half turn.
double rotation_angle_rad(const Eigen::Quaterniond& q);

/// Error phi of an estimated attitude about the horizontal axes of the estimate's own world, where q_true = Exp(phi) q
/// but for the heading, which does not count.
Eigen::Vector2d tilt_error_rad(const Eigen::Quaterniond& q_estimate, const Eigen::Quaterniond& q_true);

/// Poses of an estimate beside the truth, aligned at the first one that the truth covers. Empty when none is.
struct PairedTrack {
  Alignment alignment;
  std::vector<PairedPose> poses;
};
PairedTrack pair_poses(const Estimate& estimate, const TruthTrack& truth);

}  // namespace tumble::scenarios
