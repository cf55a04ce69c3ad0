// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "tumble/angular_velocity/detail/auxiliary_imu.hpp"
#include "tumble/angular_velocity/detail/partial_saturation.hpp"
#include "tumble/angular_velocity/detail/rate_factors.hpp"
#include "tumble/angular_velocity/detail/rate_model_params.hpp"
#include "tumble/angular_velocity/detail/saturation_limit_detector.hpp"
#include "tumble/angular_velocity/detail/saturation_plane.hpp"
#include "tumble/common/types.hpp"

namespace tumble {

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
