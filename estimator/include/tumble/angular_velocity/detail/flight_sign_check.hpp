// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>

#include "tumble/common/detail/imu_average.hpp"
#include "tumble/common/status.hpp"
#include "tumble/common/types.hpp"

namespace tumble {

/// Detects wrong signs of the accelerometer (all three axes inverted, or one axis) from the specific force in free
/// flight. Checks at rest cannot detect inverted axes, because mirrored gravity has the correct magnitude and rotation.
///
/// For a body that may be hand-held, FlightSignCheck reports only three inverted axes, because a swinging hand can
/// imitate free flight. The check needs a spinning flight with at most one clipped gyro axis, and an IMU off the centre
/// of mass. A lever arm with the wrong sign looks like an inverted accelerometer.
class FlightSignCheck {
 public:
  static constexpr double kForgettingTime_s = 60.0;

  /// number of compared sign hypotheses: no inverted axis, all axes, x, y, z
  static constexpr std::size_t kMirroredAlternatives = 5;

  enum class BodyMotionType { possibly_hand_held, always_thrown };

  struct Setup {
    BodyMotionType motion_type = BodyMotionType::possibly_hand_held;
    /// lever arm from the centre of mass to the IMU, in IMU axes
    Eigen::Vector3d lever_arm_m = Eigen::Vector3d::Zero();
    double gyro_range_rad_s = 0.0;  ///< range from the data sheet; 0: unknown
  };
  struct AveragedReading {
    TimeNs time_ns = 0;
    Eigen::Vector3d rate_rad_s = Eigen::Vector3d::Zero(), force_m_s2 = Eigen::Vector3d::Zero();
    /// sign of the saturated reading of each gyro axis; 0: unsaturated
    Eigen::Vector3d saturation_sign = Eigen::Vector3d::Zero();
    bool is_unsaturated = false;
    bool operator==(const AveragedReading&) const = default;
  };
  struct State {
    ImuAverage average;
    std::array<AveragedReading, 2> last_readings{};  ///< oldest first
    int readings = 0;
    std::array<double, kMirroredAlternatives> current_flight_duration_s{};
    std::array<double, kMirroredAlternatives>
        flight_duration_s{};        ///< total duration of flight, for each sign hypothesis
    TimeNs last_flight_end_ns = 0;  ///< end of the last flight that fits inverted axes
    TimeNs last_time_ns = 0;
    bool started = false;
    bool operator==(const State&) const = default;
  };

  /// Throws InvalidParams if a coordinate of the lever arm exceeds 1 km, or if the range is negative or not finite.
  explicit FlightSignCheck(const Setup& setup);

  /// Processes one sample. Samples that are not finite or out of order are ignored. Cost: O(1), no allocation.
  void step(const ImuSample& sample, State& state) const;

  /// Returns `out_of_range` if the specific force in flight fits an accelerometer with wrong signs.
  Status verdict(const State& state) const;
  /// Returns verdict() if the last flight that fits inverted axes is at most kForgettingTime_s old, and otherwise `ok`.
  Status current_verdict(const State& state) const;

 private:
  AveragedReading reading_of(const ImuSample& mean, double rate_peak_rad_s) const;
  void process_reading(const AveragedReading& now, State& state) const;

  Setup setup_;
};

}  // namespace tumble
