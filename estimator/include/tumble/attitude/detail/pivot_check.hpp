// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <limits>
#include <span>

#include "tumble/common/imu.hpp"
#include "tumble/common/status.hpp"

namespace tumble {

/// Checks whether rates are plausible for a body that never rests but is held by a hand, a hinge, or the ground. During
/// one or two seconds, a held body rotates about one of its points (the pivot), which hardly moves. The forces, rotated
/// by the rates, integrate to gravity times the duration plus the effect of rotation about the pivot. PivotCheck
/// compares the integrated force for the actual rates, for relabelled or inverted gyro axes, and for half or twice the
/// rate. The rates are wrong if only one of the alternatives fits the integral, in many segments. If the pivot is near
/// the sensor, as in hand-held motion, PivotCheck determines the gyro's scale to a per cent.
///
/// The equations of PivotCheck are imu_merge.md (I27), (I28), (I29), (I30). PivotCheck uses only unsaturated rates: a
/// segment ends where the gyro saturates. If a body flies or rolls, no alternative explains its motion. If a body
/// rotates about a single axis, several axis labels explain the rotation equally well. If all three axes of the
/// accelerometer are flipped, the estimated pivot only moves to the opposite side.
struct PivotCheck {
  int reading = 0;                    ///< index of the best gyro alternative; 0: unchanged gyro
  double evidence = 0.0;              ///< evidence against the unchanged rates: sum of logarithms
  std::size_t compared_segments = 0;  ///< segments that the alternative or the unchanged rates explain
  std::size_t better_segments = 0, worse_segments = 0;  ///< segments that the alternative explains better or worse
  double scale = 1.0;                                   ///< best scale of the rates, from segments with a near pivot
  double scale_sigma = std::numeric_limits<double>::infinity();
  std::size_t scale_segments = 0, explained_segments = 0;  ///< segments that determine the scale; explained segments

  /// The ranges are from the data sheet; 0: unknown. Cost: O(samples), about 1 ms per second of data at 100 Hz.
  static PivotCheck of(std::span<const ImuSample> samples, double gravity_m_s2, double gyro_range_rad_s,
                       double accel_range_m_s2);

  /// Returns `out_of_range` if an alternative of the gyro explains clearly more segments than the unchanged gyro, or if
  /// the gyro's scale is wrong.
  Status verdict() const;
};

}  // namespace tumble
