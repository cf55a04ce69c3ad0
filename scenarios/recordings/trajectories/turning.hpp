// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "sim/recording.hpp"

/// A pose file does not state the frame, the quaternion convention or the clock of its poses. A comparison of the poses
/// with a gyro determines frame, quaternion convention and clock.
namespace tumble::scenarios {

struct TimedAttitude {
  std::int64_t time_ns = 0;
  Eigen::Quaterniond q_WA = Eigen::Quaterniond::Identity();
};

struct CandidateFrame {
  std::string name;
  Eigen::Quaterniond q_AI = Eigen::Quaterniond::Identity();
};

enum class QuaternionConvention { as_stated, w_first, inverse, w_first_inverse };

/// TurningFit describes how well attitudes agree with a gyro. `difference` is the median rotation difference between
/// gyro and attitudes over pairs of attitudes, as a fraction of the median rotation.
struct TurningFit {
  QuaternionConvention written = QuaternionConvention::as_stated;
  std::size_t frame = 0;  ///< index of the candidate
  double delay_s = 0.0;   ///< positive: stamps are too late
  double difference = 0.0;
};

struct MountingFit {
  Eigen::Quaterniond q_AI = Eigen::Quaterniond::Identity();
  double delay_s = 0.0, difference = 0.0;
};

template <class Fit>
struct DelayedFit {
  Fit undelayed, delayed;

  /// Among several hundred candidate delays, one delay may fit better by chance. A delay is therefore accepted only if
  /// the delay reduces the rotation difference to less than half.
  const Fit& likely() const { return delayed.difference < 0.5 * undelayed.difference - 0.02 ? delayed : undelayed; }
};

struct TurningCheck {
  std::size_t pairs = 0;  ///< 0: too few
  TurningFit stated;
  DelayedFit<TurningFit> reading;
  DelayedFit<MountingFit> mounting;
  bool clock_known = false;  ///< a delay of 0.3 s is detectable
  bool order_known = false;  ///< wrong quaternion conventions are detectable
  /// `upright` is a quaternion convention that agrees with the gyro about as well as the stated convention. With the
  /// convention `upright`, the measured gravity is vertical in world axes; with the stated convention, it is not.
  std::optional<TurningFit> upright;
};

/// The time stamps of valid poses may be late by one sweep period (0.1 s), because some programs stamp a pose with the
/// end of the sweep.
inline constexpr double kDelaySearched_s = 5.0, kDelayMax_s = 0.15;
inline bool is_delayed(double delay_s) {
  return std::abs(delay_s) >= kDelayMax_s;
}
std::string delay_text(double delay_s);
std::string delay_remedy(double delay_s);

/// Compares the rotations between pairs of attitudes with the rotations that the gyro measures. The two attitudes of a
/// pair are separated by a time of 0.05 to 1 s and by a rotation of 0.02 to 2.5 rad. A pair is omitted if the gyro has
/// a saturated sample or a gap above 0.1 s between the two attitudes. At most 400 pairs of attitudes are used, spread
/// evenly over the recording. Fewer than 6 pairs of attitudes give no result.
///
/// @param frames Frames to which the attitudes may belong; the first frame is the user's choice.
/// @param delay_max_s Largest delay in either direction, searched in steps of 20 ms, then of 2 ms. The delay is assumed
///        0 if `delay_max_s` is 0, or if there are fewer than 20 pairs of attitudes. The search for a delay of up to
///        5 s takes half a second.
TurningCheck check_turning(std::span<const TimedAttitude> attitudes, const std::vector<CandidateFrame>& frames,
                           const sim::ImuRecord& imu, double delay_max_s);

}  // namespace tumble::scenarios
