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

/// One value per sensing element of an IMU: -1 or 1 if the element is clipped at the negative or positive limit, and 0
/// if the element is unsaturated. `kMissingSign` marks a gyro reading that is invalid because of an overflow.
struct ClipSigns {
  static constexpr std::int8_t kMissingSign = 2;
  std::array<std::int8_t, 3> gyro{}, accel{};
};
ClipSigns clip_signs(const ImuSample& sample, const Clipping& clipping);

/// Row i of `sensing_directions` is the sensing direction of gyro element i, in the axes of the gyro. While element i
/// clips, the component of (rate + bias) along row i is at or beyond the saturation limit.
struct SensingAxisClipSigns {
  Eigen::Matrix3d sensing_directions = Eigen::Matrix3d::Identity();
  std::span<const ClipSigns> clip_signs;  ///< one entry per sample; empty: no clipping
  /// Covariance of each rate that was recovered from saturation [rad^2/s^2], in sensor axes; zero for a measured rate.
  /// An empty `recovered_covariance_rad2_s2` marks all rates as measured. A sample with a recovered rate must not have
  /// clipped sensing elements.
  std::span<const Eigen::Matrix3d> recovered_covariance_rad2_s2 = {};
};

/// Estimates attitude and angular velocity of a hand-held body from one IMU over a recording, also while the gyro is
/// saturated.
///
/// HandHeldSmoother assumes that the acceleration of the hand is bounded, and that velocity and displacement of the
/// hand return to zero. While the gyro is saturated, the rotation of the measured gravity in sensor axes determines the
/// rate. HandHeldSmoother also estimates the biases and the lever arm from the hand-held point to the IMU. The
/// equations are in docs/maths/carried.md.
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
    /// During long saturation, the number of full revolutions can be ambiguous. `revolutions_tested` counts the
    /// saturated intervals in which HandHeldSmoother compared several numbers of revolutions. `revolutions_corrected`
    /// counts the saturated intervals in which another number of revolutions fitted better. `revolutions_ambiguous`
    /// counts the saturated intervals in which another number of revolutions has odds of at least 1 to 1000.
    int revolutions_tested = 0, revolutions_corrected = 0, revolutions_ambiguous = 0;
    /// Number of revolution tests in which the solver failed; the previous solution is kept.
    int revolutions_failed = 0;
  };

  /// Throws InvalidParams if a parameter is out of bounds.
  explicit HandHeldSmoother(const Params& params);

  /// `rates` contains the angular velocity of each sample, in sensor axes [rad/s]. `attitudes` contains the rotation
  /// from sensor axes to the world at each sample, with heading 0 at the start. Returns `ok`, `empty`, `non_finite`,
  /// `time_order`, `gap`, `out_of_range` (sizes of the inputs differ, or a covariance is invalid) or `diverged` (the
  /// normal equations are not positive definite). On error, the outputs are empty.
  Status estimate(std::span<const ImuSample> samples, const SensingAxisClipSigns& clipped,
                  std::vector<AngularRateState>& rates, std::vector<AttitudeState>& attitudes, Report& report) const;

 private:
  Params params_;
};

}  // namespace tumble
