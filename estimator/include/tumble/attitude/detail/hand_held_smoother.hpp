// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "tumble/angular_velocity/detail/saturation_limit_detector.hpp"
#include "tumble/angular_velocity/types.hpp"
#include "tumble/attitude/detail/hand_held_model.hpp"
#include "tumble/attitude/detail/hand_held_params.hpp"
#include "tumble/common/status.hpp"
#include "tumble/common/types.hpp"

namespace tumble {

/// One value per sensing element of an IMU: -1 or 1 if the element is clipped at its negative or positive saturation
/// limit, otherwise 0. `kMissingSign` marks a gyro reading that is invalid because of an overflow.
struct ClipSigns {
  static constexpr std::int8_t kMissingSign = 2;
  std::array<std::int8_t, 3> gyro{}, accel{};
};
ClipSigns clip_signs(const ImuSample& sample, const Clipping& clipping);

/// Row i of `sensing_directions` is the sensing direction of gyro element i, in the axes of the gyro. While element i
/// clips, the magnitude of (rate + bias) along row i is at or above the saturation limit.
struct SensingAxisClipSigns {
  Eigen::Matrix3d sensing_directions = Eigen::Matrix3d::Identity();
  std::span<const ClipSigns> clip_signs;  ///< one entry per sample; empty: no clipping
  /// Covariance of each rate that was recovered from saturation [rad^2/s^2], in sensor axes; zero for a measured rate.
  /// If the list is empty, all rates are measured. A sample with a recovered rate must not have clipped sensing
  /// elements.
  std::span<const Eigen::Matrix3d> recovered_covariance_rad2_s2 = {};
};

/// Estimates attitude and angular velocity of a hand-held body from one IMU over a recording, also while the gyro is
/// saturated.
///
/// HandHeldSmoother assumes that the hand's acceleration is bounded, and that the hand's velocity and displacement
/// return to zero. While the gyro is saturated, the changing direction of gravity in accelerometer axes determines the
/// rate. HandHeldSmoother also estimates the gyro and accelerometer biases, and the lever arm from the hand-held point
/// to the IMU. The equations are in docs/maths/carried.md.
///
/// Computation and memory (about 7 kB per time step `node_s`) are proportional to the duration of the recording, and
/// independent of the sample rate of the IMU.
///
/// HandHeldSmoother assumes constant biases and a body that is neither thrown nor hit. The heading is relative to the
/// start of the recording.
class HandHeldSmoother {
 public:
  using Params = HandHeldParams;

  struct Report {
    hand_held::Constants constants;
    hand_held::System::BorderMatrix constants_covariance = hand_held::System::BorderMatrix::Zero();
    int iterations = 0;
    bool converged = false;
    double cost = 0.0;
    /// The number of full revolutions during a long saturation can be ambiguous. The following members count saturated
    /// intervals. For `revolutions_tested`, several numbers of revolutions were compared. For `revolutions_corrected`,
    /// another number fitted better. For `revolutions_ambiguous`, another number has odds of at least 1 to 1000.
    int revolutions_tested = 0, revolutions_corrected = 0, revolutions_ambiguous = 0;
    /// number of comparisons in which the solver failed, so that the previous solution was kept
    int revolutions_failed = 0;
  };

  /// Throws InvalidParams if a parameter is out of bounds.
  explicit HandHeldSmoother(const Params& params);

  /// Estimates angular velocity `rates` (sensor axes [rad/s]) and attitude `attitudes` (sensor axes to world, heading 0
  /// at the start) at each sample. Returns `ok`, `empty`, `non_finite`, `time_order`, `gap`, `out_of_range` (sizes of
  /// the inputs differ, or a covariance is invalid) or `diverged` (the normal equations are not positive definite). On
  /// error, the outputs are empty.
  Status estimate(std::span<const ImuSample> samples, const SensingAxisClipSigns& clipped,
                  std::vector<AngularRateState>& rates, std::vector<AttitudeState>& attitudes, Report& report) const;

 private:
  Params params_;
};

}  // namespace tumble
