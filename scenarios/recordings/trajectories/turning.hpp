// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "sim/recording.hpp"

/// Attitudes compared with a gyro. A file of poses states neither whose poses they are, nor the order and direction of
/// its quaternions, nor its clock; the gyro measures all of them.
namespace tumble::scenarios {

struct TimedAttitude {
  std::int64_t time_ns = 0;
  Eigen::Quaterniond q_WA = Eigen::Quaterniond::Identity();
};

/// A frame whose attitudes they may be.
struct CandidateFrame {
  std::string name;
  Eigen::Quaterniond q_AI = Eigen::Quaterniond::Identity();  ///< IMU coordinates to those of the frame
};

/// What a file may mean by its quaternions.
enum class Written { as_stated, w_first, inverse, w_first_inverse };

/// One reading of the attitudes, and how far their rotations then differ from the gyro's: the median over the pairs, as
/// a share of the median rotation.
struct TurningFit {
  Written written = Written::as_stated;
  std::size_t frame = 0;  ///< index of the candidate
  double delay_s = 0.0;   ///< attitudes bear stamps that are so much too late
  double difference = 0.0;
};

/// The mounting of the IMU in the frame that fits best, with attitudes read as stated.
struct MountingFit {
  Eigen::Quaterniond q_AI = Eigen::Quaterniond::Identity();
  double delay_s = 0.0, difference = 0.0;
};

/// The best fits without a delay, and with one.
template <class Fit>
struct DelayedFit {
  Fit undelayed, delayed;

  /// The delayed one where it leaves less than half of the difference, less 0.02: a few hundred delays fit somewhat
  /// better by chance.
  const Fit& likely() const { return delayed.difference < 0.5 * undelayed.difference - 0.02 ? delayed : undelayed; }
};

struct TurningCheck {
  std::size_t pairs = 0;  ///< that the gyro covers; 0 where there are too few to decide
  TurningFit stated;
  DelayedFit<TurningFit> reading;
  DelayedFit<MountingFit> mounting;
  bool clock_known = false;  ///< a delay of 0.3 s would show
  bool order_known = false;  ///< another order or direction of the quaternions would show
  /// Another order or direction whose rotations agree as well; gravity is vertical in it, but not as stated.
  std::optional<TurningFit> upright;
};

/// Rotations from attitude to attitude, 0.05 to 1 s and 0.02 to 2.5 rad apart, against those of the gyro (products of
/// the exponentials of its samples, none at its rail, no gap beyond 0.1 s). At most 400 pairs, evenly over the
/// recording; fewer than 6 decide nothing.
///
/// @param frames       Candidates; the first is the one that is stated.
/// @param delay_max_s  Delays are searched to both sides, in steps of 20 ms, then of 2 ms. Fewer than 20 pairs decide
///                     no delay. 0: none is searched.
/// Cost: O(N log N + pairs x delays), half a second at 5 s.
TurningCheck check_turning(std::span<const TimedAttitude> attitudes, const std::vector<CandidateFrame>& frames,
                           const sim::ImuRecord& imu, double delay_max_s);

}  // namespace tumble::scenarios
