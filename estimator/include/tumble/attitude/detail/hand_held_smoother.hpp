// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "tumble/angular_velocity/detail/rail_detector.hpp"
#include "tumble/angular_velocity/rate_state.hpp"
#include "tumble/attitude/detail/hand_held_model.hpp"
#include "tumble/attitude/detail/hand_held_params.hpp"
#include "tumble/common/imu.hpp"
#include "tumble/common/pose.hpp"
#include "tumble/common/status.hpp"

namespace tumble {

/// ClipSigns contains one value per sensing element of an IMU: -1 if clipped at the negative limit, 1 if clipped at the
/// positive limit, 0 if unsaturated. The value kMissing marks a gyro reading that is invalid because of an overflow.
struct ClipSigns {
  static constexpr std::int8_t kMissing = 2;
  std::array<std::int8_t, 3> gyro{}, accel{};
};
/// Returns the clipped sensing elements of a sample that RailDetector or ClippingFinder classified.
ClipSigns clip_signs(const ImuSample& sample, const Clipping& clipping);

/// ClippedElements describes the saturation of an IMU over a recording. Gyro element i measures the component of the
/// rate along m_i, which is row i of `rows`. While gyro element i clips, the component m_i' y of the reading y equals
/// the saturation limit. The magnitude of the true component m_i' (rate + bias) is then at least the saturation limit.
struct ClippedElements {
  Eigen::Matrix3d rows = Eigen::Matrix3d::Identity();
  std::span<const ClipSigns> signs;  ///< one entry per sample; empty: no clipping
  /// Covariance of each rate that was recovered from the equations of flight, in sensor axes. A covariance of zero
  /// marks a measured rate, and an empty span marks all rates as measured. A sample with a recovered rate must not have
  /// clipped sensing elements.
  std::span<const Eigen::Matrix3d> recovered_covariance_rad2_s2 = {};
};

/// Estimates attitude and angular velocity of a hand-held body (held, swung, twirled) from one IMU, also while the gyro
/// is saturated. HandHeldSmoother processes a whole recording.
///
/// Hand-held motion is bounded: accelerations are short, and the velocity and displacement of the hand return to zero.
/// The specific force is therefore the sum of gravity, the centripetal and tangential force at the lever arm, and a
/// bounded remainder. The rotation of the measured gravity vector in sensor axes determines the rate while the gyro is
/// saturated. HandHeldSmoother estimates attitude, rate, angular acceleration and hand motion at equal time steps,
/// called nodes. HandHeldSmoother also estimates the biases and the lever arm of the IMU. A Gauss-Newton solver uses
/// the arrow structure of the normal equations, and the inverse of the normal matrix gives the covariances. Memory
/// (about 7 kB per node) and computation are proportional to the duration, and independent of the IMU's sample rate.
///
/// HandHeldSmoother assumes that the body is not thrown (see `hand_acceleration_ratio`) and has no hard contact.
/// HandHeldSmoother assumes constant biases, and reports the heading relative to the start.
class HandHeldSmoother {
 public:
  using Params = HandHeldParams;

  struct Report {
    hand_held::Constants constants;
    hand_held::System::BorderMatrix constants_covariance = hand_held::System::BorderMatrix::Zero();
    int iterations = 0;
    bool converged = false;
    double cost = 0.0;
    /// Largest mean acceleration of the hand over a quarter of a second, divided by the assumed standard deviation. A
    /// ratio above 2 indicates that the body was thrown (specific force about 0) or handled roughly. The ratio is a
    /// diagnostic and does not influence the estimate.
    double hand_acceleration_ratio = 0.0;
    /// During long clipping, the number of full revolutions can be ambiguous. HandHeldSmoother tests other numbers of
    /// revolutions in `revolutions_tested` clipped segments. The counter revolutions_corrected counts, in each round,
    /// the segments in which another number of revolutions fitted better. The counter revolutions_ambiguous counts
    /// segments in which another number has odds of at least 1 to 1000. The rate covariance includes the spread of the
    /// possible numbers of revolutions.
    int revolutions_tested = 0, revolutions_corrected = 0, revolutions_ambiguous = 0;
    /// Number of revolution tests in which the solver failed. HandHeldSmoother then restores the previous solution, and
    /// counts the segment in revolutions_ambiguous.
    int revolutions_failed = 0;
  };

  /// Throws InvalidParams if a parameter is out of bounds.
  explicit HandHeldSmoother(const Params& params);

  /// Estimates one rate and one attitude per sample. The output `rates` contains the angular velocity of each sample,
  /// in sensor axes [rad/s]. The output `attitudes` contains the rotation from sensor axes to the world at each sample,
  /// with heading 0 at the start. Returns `ok`, `empty`, `non_finite`, `time_order`, `gap`, `out_of_range` or
  /// `diverged`. On error, the outputs are empty. The error `out_of_range` means that the input arrays have different
  /// sizes or that a covariance is invalid. The error `diverged` means that the normal equations are not positive
  /// definite.
  Status estimate(std::span<const ImuSample> samples, const ClippedElements& clipped, std::vector<RateState>& rates,
                  std::vector<AttitudeState>& attitudes, Report& report) const;

 private:
  Params params_;
};

}  // namespace tumble
