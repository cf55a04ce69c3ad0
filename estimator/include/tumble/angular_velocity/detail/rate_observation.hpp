// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "tumble/angular_velocity/auxiliary_imu.hpp"
#include "tumble/angular_velocity/detail/rate_factors.hpp"
#include "tumble/angular_velocity/detail/subsample_saturation.hpp"
#include "tumble/angular_velocity/rail_detector.hpp"
#include "tumble/angular_velocity/rail_plane.hpp"
#include "tumble/angular_velocity/rate_model_params.hpp"
#include "tumble/common/imu.hpp"

namespace tumble {

/// One sample as the model sees it.
struct RateObservation {
  ImuSample sample;
  Clipping clipping;
  bool at_rest = false;  ///< standstill: the rate is zero, see RestDetector
  // Axes that are read with a deviation of their own, bit j of each for axis j; an axis is one of the three at most.
  std::uint8_t subsample_saturated =
      0;                  ///< met the rail in a part of its window only, as the device says: see SubsampleSaturation
  std::uint8_t lone = 0;  ///< few readings as high as other elements' rails, on a side whose own rail nobody has seen
  std::uint8_t doubted = 0;  ///< a run of readings that may all stand at a rail nobody has seen: at least what is read
  Eigen::Vector3d lost_rad_s = Eigen::Vector3d::Zero();        ///< of such axes, signed as the reading
  Eigen::Vector3d lost_sigma_rad_s = Eigen::Vector3d::Zero();  ///< of all three
  /// How old the triads' readings are at the stamp of the sample, and whether the gyro's is that of the sample before.
  double gyro_age_s = 0.0, accel_age_s = 0.0;
  bool gyro_repeats = false;
  ElementRows accel_rows = {};  ///< of the accelerometer's elements: of use where one of them clips
  std::array<AuxiliaryReading, kAuxiliaryImusMax> auxiliary_imus =
      {};  ///< in the order of RateModelParams::auxiliary_imus

  /// Whether an element clips, so that the readings of all axes are off: it is read element by element.
  bool by_elements() const { return (clipping.gyro | clipping.missing_gyro) != 0; }

  /// Axes that are read, but not as well as the gyro reads.
  std::uint8_t read_in_part() const { return static_cast<std::uint8_t>(subsample_saturated | lone | doubted); }
  /// Axes whose reading may be less than the rate, though no rail was found there.
  std::uint8_t may_hide() const { return static_cast<std::uint8_t>(lone | doubted); }

  /// Axes whose rate is not read: bound at most.
  std::uint8_t unseen() const {
    for (const AuxiliaryReading& auxiliary_imu : auxiliary_imus) {
      if (auxiliary_imu.sees_all_rates()) return 0;
    }
    return static_cast<std::uint8_t>((clipping.gyro | clipping.missing_gyro) &
                                     ~(subsample_saturated & ~clipping.missing_gyro));
  }
};

/// Finds the axes saturated for a part of the window, of `now` from the samples beside it (null where there is none).
void mark_subsample_saturation(const RailDetector& rails, const RailDetector::State& state, double noise_rad_s,
                               const ImuSample* before, RateObservation& now, const ImuSample* after);

/// What is estimated of one sample.
struct RateEstimate {
  RateKnot knot;
  double flight_weight = 0.0;  ///< 0: contact, 1: free flight
  /// Specific force of contact at the centre of mass: what the flight model does not explain.
  Eigen::Vector3d contact_m_s2 = Eigen::Vector3d::Zero();
  /// What the bounds of clipped elements amount to, as Gaussian sites on what each hides, m_j . (rate + bias -
  /// reading): precision and precision * mean.
  Eigen::Vector3d bound_precision = Eigen::Vector3d::Zero();
  Eigen::Vector3d bound_shift = Eigen::Vector3d::Zero();
  bool soft_bounds = false;  ///< false: bounds are hard, they act only when violated (for the first iterations)
};

}  // namespace tumble
