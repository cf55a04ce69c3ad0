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
  bool at_rest = false;  ///< the rate is zero, see RestDetector
  // bit masks of axes whose readings have a separate standard deviation; an axis is in at most one mask
  std::uint8_t partial_saturation_flags = 0;  ///< saturated during a part of the sample, see PartialSaturation
  std::uint8_t rarely_high_axes = 0;          ///< few high readings, whose saturation limit is unknown
  std::uint8_t suspected_saturation = 0;      ///< readings that may be at an unknown saturation limit: lower bounds
  Eigen::Vector3d expected_saturation_deficit_rad_s =
      Eigen::Vector3d::Zero();  ///< expected saturation deficit, with the reading's sign
  Eigen::Vector3d saturation_deficit_sigma_rad_s =
      Eigen::Vector3d::Zero();  ///< standard deviation of expected_saturation_deficit_rad_s
  /// ages of the readings at the time stamp of the sample
  double gyro_age_s = 0.0, accel_age_s = 0.0;
  bool gyro_repeats = false;
  SensingDirections accel_sensing_directions =
      {};  ///< sensing directions of the accelerometer; needed if an element clips
  std::array<AuxiliaryReading, kAuxiliaryImusMax> auxiliary_imus =
      {};  ///< readings in the order of AngularRateModelParams::auxiliary_imus

  /// Returns true if a gyro element clips or is unusable, so that the gyro must be used element by element.
  bool has_clipped_sensing_axis() const { return (clipping.gyro | clipping.unusable_gyro) != 0; }

  /// Returns the axes whose readings have a larger standard deviation than the gyro's noise.
  std::uint8_t partly_saturated_axes() const {
    return static_cast<std::uint8_t>(partial_saturation_flags | rarely_high_axes | suspected_saturation);
  }
  std::uint8_t possibly_saturated_axes() const {
    return static_cast<std::uint8_t>(rarely_high_axes | suspected_saturation);
  }

  /// Returns the axes whose rate has no measurement or only a lower bound.
  std::uint8_t unmeasured_axes() const {
    for (const AuxiliaryReading& auxiliary_imu : auxiliary_imus) {
      if (auxiliary_imu.measures_all_rates()) return 0;
    }
    return static_cast<std::uint8_t>((clipping.gyro | clipping.unusable_gyro) &
                                     ~(partial_saturation_flags & ~clipping.unusable_gyro));
  }
};

/// `before` and `after` are null if absent.
void mark_partial_saturation(const SaturationLimitDetector& rails, const SaturationLimitDetector::State& state,
                             double noise_rad_s, const ImuSample* before, AngularRateObservation& now,
                             const ImuSample* after);

struct AngularRateEstimate {
  AngularRateKnot knot;
  double flight_weight = 0.0;  ///< 0: contact, 1: free flight
  /// force that contact causes at the centre of mass, per mass
  Eigen::Vector3d contact_force_m_s2 = Eigen::Vector3d::Zero();
  /// Gaussian factors that approximate the lower bounds of clipped elements, stored as precision and precision * mean.
  Eigen::Vector3d lower_bound_precision = Eigen::Vector3d::Zero();
  Eigen::Vector3d lower_bound_information_mean = Eigen::Vector3d::Zero();
  bool use_soft_bounds = false;  ///< false: lower bounds are hard, and act only if violated
};

}  // namespace tumble
