// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "tumble/angular_velocity/rail_detector.hpp"
#include "tumble/angular_velocity/rate_state.hpp"
#include "tumble/attitude/carried_params.hpp"
#include "tumble/attitude/detail/carried_model.hpp"
#include "tumble/common/imu.hpp"
#include "tumble/common/pose.hpp"
#include "tumble/common/status.hpp"

namespace tumble {

/// Clipped sensing elements of an IMU in one sample: -1 at the negative saturation level, 1 at the positive one, 0
/// unsaturated. The value kMissing marks gyro readings that have overflowed and provide neither a measurement nor a
/// lower bound.
struct ClipSigns {
  static constexpr std::int8_t kMissing = 2;
  std::array<std::int8_t, 3> gyro{}, accel{};
};
/// Returns the clipped sensing elements of a classified sample.
ClipSigns clip_signs(const ImuSample& sample, const Clipping& clipping);

/// Saturation of an IMU. Sensing element i measures the component along row i of `rows`, called m_i. While element i
/// clips, the component m_i' y of the reading y equals the saturation level. The true value m_i' (rate + bias) is then
/// at or beyond the saturation level.
struct ClippedElements {
  Eigen::Matrix3d rows = Eigen::Matrix3d::Identity();
  std::span<const ClipSigns> signs;  ///< one per sample; empty: no clipping
  /// Covariance of each sample's rate that was recovered from other information (flight) instead of measured, sensor
  /// axes. Zero marks a measured rate; an empty span marks all rates as measured. Elements of recovered samples must
  /// not be marked as clipped.
  std::span<const Eigen::Matrix3d> recovered_rad2_s2 = {};
};

/// Estimates attitude and angular velocity of a hand-held body (held, swung, twirled) from one IMU, also while its gyro
/// is saturated. CarriedSmoother is a smoother over a whole recording.
///
/// Hand-held motion is bounded: accelerations are short, and velocity and position return to zero. The specific force
/// is therefore gravity at the attitude, the contribution of the lever arm, and a bounded remainder. The rotation of
/// gravity in the sensor determines a rate that the saturated gyro could not measure. Nodes at equal times contain
/// attitude, rate, angular acceleration, and the held point's acceleration, velocity and position. The device's
/// constants are additional unknowns. The Gauss-Newton solver uses the arrow matrix (ArrowSystem). Covariances come
/// from the same factors. Memory (about 7 kB per node) and computation are O(time), whatever the IMU's rate.
///
/// CarriedSmoother does not model flight (a thrown body; see `hand_mahalanobis`), contact with forces beyond hand-held
/// motion, drift of the biases, or heading.
class CarriedSmoother {
 public:
  using Params = CarriedParams;

  struct Report {
    carried::Constants constants;
    carried::System::BorderMatrix constants_covariance = carried::System::BorderMatrix::Zero();
    int iterations = 0;
    bool converged = false;
    double cost = 0.0;
    /// Largest mean acceleration of the held point over a quarter of a second, in assumed standard deviations. A thrown
    /// body (specific force about 0) or rough handling gives 2 and more. hand_mahalanobis is only a diagnostic.
    double hand_mahalanobis = 0.0;
    /// Clipped segments in which the number of revolutions may differ by one from the solution. `asked`: segments that
    /// are long and uncertain enough for a test. `taken`: segments in which another number fitted better and was used,
    /// counted in each round. `open`: segments in which another number remains possible, at odds of at least 1 to 1000.
    /// The covariance includes the spread of the possible numbers.
    int revolutions_asked = 0, revolutions_taken = 0, revolutions_open = 0;
    /// Changes of revolutions after which the whole problem could not be solved. The solution without failed changes is
    /// kept, and their segments count as open.
    int revolutions_failed = 0;
  };

  /// Throws InvalidParams if a parameter is out of bounds.
  explicit CarriedSmoother(const Params& params);

  /// Computes one rate and one attitude per sample (sensor axes to world, heading 0 at the start). Errors are `empty`,
  /// `non_finite`, `time_order`, `gap`, `out_of_range` and `diverged`. `out_of_range`: signs or recovered rates do not
  /// have one element per sample, or a covariance is invalid. `diverged`: the normal equations are not positive
  /// definite. On error the outputs are empty.
  Status estimate(std::span<const ImuSample> samples, const ClippedElements& clipped, std::vector<RateState>& rates,
                  std::vector<AttitudeState>& attitudes, Report& report) const;

 private:
  Params params_;
};

}  // namespace tumble
