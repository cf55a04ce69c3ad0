// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstdint>

#include "tumble/angular_velocity/detail/auxiliary_imu.hpp"
#include "tumble/angular_velocity/detail/rate_model_params.hpp"
#include "tumble/angular_velocity/detail/saturation_limit_detector.hpp"
#include "tumble/angular_velocity/detail/saturation_plane.hpp"
#include "tumble/angular_velocity/types.hpp"
#include "tumble/common/types.hpp"

namespace tumble {

/// Saturation deficit (true rate minus reading) of a gyro reading, if the gyro is saturated during a part of the
/// averaging window.
struct PartialSaturation {
  bool saturated = false;
  double expected_saturation_deficit_rad_s = 0.0;  ///< expected |true rate| - |reading|
  double sigma_rad_s = 0.0;
};

/// Estimates the saturation deficit of a partly saturated gyro reading from an unsaturated neighbouring reading, for
/// constant angular acceleration: rails.md (R70). `neighbour_rad_s` is the smaller of the two neighbouring readings,
/// with a sign for which the saturation limit is positive.
PartialSaturation partial_saturation(double reading_rad_s, double neighbour_rad_s, double rail_rad_s,
                                     double noise_rad_s);

/// Returns the smaller of the readings of the samples `before` and `after`, which may be null: rails.md (R70). `read`
/// converts an angular velocity to the reading of a sensing element. A reading flagged as saturated is used only if
/// most of its averaging window was unsaturated. Returns the saturation limit if there is no usable neighbour.
template <class Read>
double unsaturated_neighbour_reading(double reading_rad_s, double rail_rad_s, int axis, const ImuSample* before,
                                     const ImuSample* after, const Read& read) {
  double smallest = rail_rad_s;
  for (const ImuSample* beside : {before, after}) {
    if (beside == nullptr) continue;
    const double there = read(beside->angular_velocity_rad_s);
    const bool flagged = (beside->device_clip_flags >> axis & 1u) != 0;
    if (!flagged || reading_rad_s - there > 2.0 * (rail_rad_s - reading_rad_s)) smallest = std::min(smallest, there);
  }
  return smallest;
}

struct AngularRateKnot {
  Eigen::Vector3d rate_rad_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d acceleration_rad_s2 = Eigen::Vector3d::Zero();
  bool operator==(const AngularRateKnot&) const = default;
};

/// Residual with three components, and its derivatives with respect to rate, angular acceleration and rig constants.
struct AngularRateFactor {
  Eigen::Vector3d residual;
  Eigen::Matrix<double, 3, 6> jacobian_knot;
  Eigen::Matrix<double, 3, BodyImuConstants::kSize> jacobian_calibration;
};

/// Residual of an unsaturated gyro reading: rate + bias - reading [rad/s].
AngularRateFactor gyro_factor(const AngularRateKnot& knot, const BodyImuConstants& rig,
                              const Eigen::Vector3d& reading_rad_s);

/// Residuals of the three sensing elements of a gyro while an element clips: component of (rate + bias - reading) along
/// the sensing direction [rad/s].
AngularRateFactor sensing_axis_factor(const AngularRateKnot& knot, const BodyImuConstants& rig,
                                      const Eigen::Vector3d& reading_rad_s);

/// Residual of the specific force in free flight [m/s^2]: tangential plus centripetal force at the lever arm, plus
/// bias, minus reading.
AngularRateFactor flight_force_factor(const AngularRateKnot& knot, const BodyImuConstants& rig,
                                      const Eigen::Vector3d& reading_m_s2);

/// Residual of the specific force in free flight [m/s^2], for an accelerometer that is `delay_s` late relative to the
/// gyro. `jacobian_delay` (or null) receives the derivative of the residual with respect to the delay.
AngularRateFactor delayed_flight_force_factor(const AngularRateKnot& knot, const BodyImuConstants& rig,
                                              const Eigen::Vector3d& reading_m_s2, double delay_s,
                                              Eigen::Vector3d* jacobian_delay);

/// Residual of delayed_flight_force_factor() with derivatives only with respect to lever arm and accelerometer bias, at
/// lower cost.
AngularRateFactor delayed_flight_calibration_jacobian(const AngularRateKnot& knot, const BodyImuConstants& rig,
                                                      const Eigen::Vector3d& reading_m_s2, double delay_s);

/// Returns the second time derivative of the specific force at the lever arm in free flight [m/s^4].
Eigen::Vector3d flight_angular_jerk(const AngularRateKnot& knot, const BodyImuConstants& rig);

/// Residual of Euler's equation without torque, with the inertia scaled to trace 3 [rad/s^2].
AngularRateFactor euler_equation_factor(const AngularRateKnot& knot, const BodyImuConstants& rig);

struct AngularRateObservation {
  ImuSample sample;
  Clipping clipping;
  bool at_rest = false;  ///< RestDetector has detected rest, so the rate is zero
  // Bit masks of gyro axes whose readings need a larger standard deviation. Each axis is in at most one mask.
  std::uint8_t partial_saturation_flags = 0;  ///< saturated during a part of the averaging window: PartialSaturation
  std::uint8_t rarely_high_axes = 0;          ///< close to the saturation limit of another axis; own limit unknown
  std::uint8_t suspected_saturation = 0;  ///< readings that may be saturated at an unknown limit; used as lower bounds
  Eigen::Vector3d expected_saturation_deficit_rad_s = Eigen::Vector3d::Zero();  ///< expected true rate minus reading
  Eigen::Vector3d saturation_deficit_sigma_rad_s = Eigen::Vector3d::Zero();
  /// ages of the gyro and accelerometer readings at the time stamp of the sample
  double gyro_age_s = 0.0, accel_age_s = 0.0;
  bool gyro_repeats = false;
  SensingDirections accel_sensing_directions = {};  ///< needed if an accelerometer element clips
  std::array<AuxiliaryReading, kAuxiliaryImusMax> auxiliary_imus =
      {};  ///< in the order of AngularRateModelParams::auxiliary_imus

  /// Returns true if a sensing element of the gyro clips or is unusable. The gyro must then be used element by element.
  bool has_clipped_sensing_axis() const { return (clipping.gyro | clipping.unusable_gyro) != 0; }

  /// Returns the gyro axes whose readings have a larger standard deviation than the gyro's noise.
  std::uint8_t partly_saturated_axes() const {
    return static_cast<std::uint8_t>(partial_saturation_flags | rarely_high_axes | suspected_saturation);
  }
  std::uint8_t possibly_saturated_axes() const {
    return static_cast<std::uint8_t>(rarely_high_axes | suspected_saturation);
  }

  /// Returns the gyro axes with no reading or only a lower bound of the rate.
  std::uint8_t unmeasured_axes() const {
    for (const AuxiliaryReading& auxiliary_imu : auxiliary_imus) {
      if (auxiliary_imu.measures_all_rates()) return 0;
    }
    return static_cast<std::uint8_t>((clipping.gyro | clipping.unusable_gyro) &
                                     ~(partial_saturation_flags & ~clipping.unusable_gyro));
  }
};

/// Marks axes whose saturation covers a part of the averaging window. `before` and `after` are the neighbouring
/// samples, or null if absent.
void mark_partial_saturation(const SaturationLimitDetector& rails, const SaturationLimitDetector::State& state,
                             double noise_rad_s, const ImuSample* before, AngularRateObservation& now,
                             const ImuSample* after);

struct AngularRateEstimate {
  AngularRateKnot knot;
  double flight_weight = 0.0;  ///< 0: contact, 1: free flight
  /// contact force on the body, divided by the mass
  Eigen::Vector3d contact_force_m_s2 = Eigen::Vector3d::Zero();
  /// Gaussian approximation of the lower bound on each clipped sensing element, stored as precision and precision *
  /// mean.
  Eigen::Vector3d lower_bound_precision = Eigen::Vector3d::Zero();
  Eigen::Vector3d lower_bound_information_mean = Eigen::Vector3d::Zero();
  bool use_soft_bounds =
      false;  ///< true: Gaussian approximation of lower bounds; false: lower bounds act only if violated
};

}  // namespace tumble
