// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

#include "tumble/common/detail/imu_average.hpp"
#include "tumble/common/status.hpp"
#include "tumble/common/types.hpp"

namespace tumble {

/// Detects a wrong scale or sign of the gyro, and a gyro or accelerometer that repeats one reading (frozen).
///
/// The scale check compares how the direction of gravity rotates in accelerometer axes with the rotation that the gyro
/// measures: imu_merge.md (I20).
///
/// A sensor is frozen if one reading repeats bit for bit for at least a second, and ten times longer than any earlier
/// repetition. A gyro that is saturated on all axes is not frozen. A gyro with constant readings is frozen only if the
/// specific force excludes rest. An accelerometer that always reads 0 is frozen if the gyro measures motion.
///
/// ImuPlausibility does not detect errors of a few per cent, exchanged axes, or errors while the body is pushed.
class ImuPlausibility {
 public:
  struct Setup {
    double gravity_m_s2 = 9.80665;
    double gyro_range_rad_s =
        1e6;  ///< windows with a larger rate component are ignored; a gyro with all components above is saturated
  };

  struct RepeatedReadingTime {
    Eigen::Vector3d reading = Eigen::Vector3d::Zero();
    double repeated_s = 0.0, longest_s = 0.0, changing_readings_duration_s = 0.0;
    double frozen_s = 0.0;
    bool operator==(const RepeatedReadingTime&) const = default;
  };
  struct State {
    RepeatedReadingTime gyro, accel;
    ImuAverage average;
    Eigen::Vector3d window_start_force_m_s2 = Eigen::Vector3d::Zero();
    Eigen::Quaterniond gyro_rotation_in_window =
        Eigen::Quaterniond::Identity();  ///< rotation within the window, from the gyro
    double length_s = 0.0;
    bool window_started = false, force_is_constant = false;
    bool in_range = true;
    double moving_force_duration_s = 0.0;  ///< time in which the specific force excluded rest
    double unexplained_force_rotation_rad2 =
        0.0;  ///< squared rotation of the specific force that the gyro does not explain
    double force_rotation_square_sum_rad2 = 0.0,
           gyro_rotation_square_sum_rad2 = 0.0;  ///< sums over the windows in which the specific force rotates
    double rotated_window_count = 0.0;
    TimeNs last_time_ns = 0;
    bool started = false;
    bool operator==(const State&) const = default;
  };

  /// Throws InvalidParams if gravity is beyond [1e-12, 100] m/s^2, or the range beyond [1e-3, 1e6] rad/s.
  explicit ImuPlausibility(const Setup& setup);

  /// Processes one sample. Samples that are not finite or out of order are ignored. Cost: O(1), no allocation.
  void step(const ImuSample& sample, State& state) const;

  /// Reduces the weight of samples older than about a minute, so that a finding ends after its cause.
  static void limit_memory(State& state);

  /// Returns the ratio of the rotation of gravity, measured by the accelerometer, to the rotation measured by the gyro:
  /// imu_merge.md (I20). The ratio is 1 for a correct gyro, 2 for a gyro with half the scale, -1 for an inverted gyro,
  /// and 1 while unknown.
  double force_to_gyro_rotation_ratio(const State& state) const;
  /// Returns the correlation between the rotations from gyro and accelerometer. The correlation is 1 for a gyro of any
  /// positive scale, -1 for an inverted gyro, about 0 for swapped axes, and 1 while unknown.
  double rotation_agreement(const State& state) const;
  /// Returns the longest time for which the gyro or the accelerometer was frozen [s].
  double frozen_s(const State& state) const;
  /// Returns `out_of_range` with the name of the implausible quantity, or `ok`.
  Status verdict(const State& state) const;

 private:
  /// Returns true if an inverted or rescaled gyro would explain the rotation of the specific force far better.
  bool fits_better(const State& state) const;
  void process_averaged_reading(State& state) const;
  void compare_rotations(const Eigen::Vector3d& force_m_s2, State& state) const;

  Setup setup_;
};

}  // namespace tumble
