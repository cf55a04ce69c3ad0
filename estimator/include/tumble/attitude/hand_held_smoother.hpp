// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "tumble/angular_velocity/rail_detector.hpp"
#include "tumble/angular_velocity/rate_state.hpp"
#include "tumble/attitude/detail/hand_held_model.hpp"
#include "tumble/attitude/hand_held_params.hpp"
#include "tumble/common/imu.hpp"
#include "tumble/common/pose.hpp"
#include "tumble/common/status.hpp"

namespace tumble {

/// ClipSigns states for each sensing element of an IMU whether one sample is clipped. An element of ClipSigns is -1 at
/// the negative saturation level, 1 at the positive saturation level, and 0 if unsaturated. The value kMissing marks a
/// gyro reading that has overflowed and provides neither a measurement nor a lower bound.
struct ClipSigns {
  static constexpr std::int8_t kMissing = 2;
  std::array<std::int8_t, 3> gyro{}, accel{};
};
/// Returns the clipped sensing elements of a sample that RailDetector or ClippingFinder classified.
ClipSigns clip_signs(const ImuSample& sample, const Clipping& clipping);

/// ClippedElements describes the saturation of an IMU over a recording. Sensing element i of the gyro measures the
/// component of the rate along m_i, which is row i of `rows`. While sensing element i clips, the component m_i' y of
/// the reading y equals the saturation level. The true component m_i' (rate + bias) of a clipped element is at or
/// beyond the saturation level.
struct ClippedElements {
  Eigen::Matrix3d rows = Eigen::Matrix3d::Identity();
  std::span<const ClipSigns> signs;  ///< one per sample; empty: no clipping
  /// Covariance of each sample's rate, in sensor axes, if the rate was recovered from the equations of flight instead
  /// of measured. A covariance of zero marks a measured rate; an empty span marks all rates as measured. Sensing
  /// elements of samples with a recovered rate must not be marked as clipped.
  std::span<const Eigen::Matrix3d> recovered_covariance_rad2_s2 = {};
};

/// Estimates attitude and angular velocity of a hand-held body (held, swung, twirled) from one IMU, also while the gyro
/// is saturated. HandHeldSmoother processes a whole recording.
///
/// Hand-held motion is bounded: accelerations are short, and the velocity and displacement of the hand return to zero.
/// The specific force is therefore the sum of gravity, the centripetal and tangential force at the lever arm, and a
/// bounded remainder. The direction of gravity rotates in sensor axes, and the rotation of gravity determines the rate
/// while the gyro is saturated. Nodes at equal time steps contain attitude, rate and angular acceleration, and the
/// motion of the held point (the point of the body at the hand). Biases and lever arm of the device are additional
/// unknowns. A Gauss-Newton solver uses the arrow structure of the normal equations (ArrowSystem). The inverse of the
/// normal equations gives the covariances. Memory (about 7 kB per node) and computation grow in proportion to the
/// duration, whatever the IMU's sample rate.
///
/// HandHeldSmoother does not model flight of a thrown body (see `hand_acceleration_ratio`), contact forces beyond
/// hand-held motion, drift of the biases, or heading.
class HandHeldSmoother {
 public:
  using Params = HandHeldParams;

  struct Report {
    hand_held::Constants constants;
    hand_held::System::BorderMatrix constants_covariance = hand_held::System::BorderMatrix::Zero();
    int iterations = 0;
    bool converged = false;
    double cost = 0.0;
    /// Largest mean acceleration of the held point (at the hand) over a quarter of a second, divided by the assumed
    /// standard deviation. The value of hand_acceleration_ratio exceeds 2 if the body was thrown (specific force about
    /// 0) or handled roughly. The value hand_acceleration_ratio is a diagnostic and does not influence the estimate.
    double hand_acceleration_ratio = 0.0;
    /// Number of clipped segments whose number of full revolutions is ambiguous. The counter revolutions_tested counts
    /// clipped segments that are long and uncertain enough for a test of another number of revolutions. The counter
    /// revolutions_corrected counts, in each round, the segments where another number of revolutions fitted better and
    /// was used. The counter revolutions_ambiguous counts segments where another number of revolutions remains
    /// possible, at odds of at least 1 to 1000. The rate covariance includes the spread of the possible numbers of
    /// revolutions.
    int revolutions_tested = 0, revolutions_corrected = 0, revolutions_ambiguous = 0;
    /// Number of attempted changes of revolutions for which the solver failed. HandHeldSmoother keeps the solution
    /// before a failed change, and counts the segment in revolutions_ambiguous.
    int revolutions_failed = 0;
  };

  /// Throws InvalidParams if a parameter is out of bounds.
  explicit HandHeldSmoother(const Params& params);

  /// Computes one rate and one attitude per sample.
  /// `rates` contains the angular velocity of each sample, in sensor axes [rad/s]. `attitudes` contains the rotation
  /// from sensor axes to the world at each sample, with heading 0 at the start.
  /// Returns `ok`, `empty`, `non_finite`, `time_order`, `gap`, `out_of_range` or `diverged`. On error the outputs are
  /// empty. The error `out_of_range` means that signs or recovered rates do not have one element per sample, or that a
  /// covariance is invalid. The error `diverged` means that the normal equations are not positive definite.
  Status estimate(std::span<const ImuSample> samples, const ClippedElements& clipped, std::vector<RateState>& rates,
                  std::vector<AttitudeState>& attitudes, Report& report) const;

 private:
  Params params_;
};

}  // namespace tumble
