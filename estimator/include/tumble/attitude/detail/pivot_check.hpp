// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <limits>
#include <span>

#include "tumble/common/status.hpp"
#include "tumble/common/types.hpp"

namespace tumble {

/// Checks whether rates are plausible for a body that never rests but is held by a hand, a hinge, or the ground. A held
/// body rotates for one or two seconds about a point that hardly moves (the pivot). PivotMotionCheck compares the
/// integrated force for the measured rates, for relabelled or inverted gyro axes, and for half or twice the rate:
/// imu_merge.md (I27), (I28), (I29), (I30).
///
/// PivotMotionCheck uses only unsaturated rates. PivotMotionCheck does not detect wrong rates of a body that flies or
/// rolls, and wrong axis labels of a body that rotates about a single axis. PivotMotionCheck does not detect that all
/// three axes of the accelerometer are flipped.
struct PivotMotionCheck {
  int reading = 0;                      ///< index of the best gyro alternative; 0: unchanged gyro
  double log_evidence = 0.0;            ///< evidence against the unchanged rates: sum of logarithms
  std::size_t comparable_segments = 0;  ///< segments that the alternative or the unchanged rates explain
  std::size_t better_explained_segments = 0,
              worse_explained_segments = 0;  ///< segments that the alternative explains better or worse
  double scale = 1.0;                        ///< best scale of the rates, from segments with a near pivot
  double scale_sigma = std::numeric_limits<double>::infinity();
  std::size_t gyro_scale_segments = 0,
              segments_explained_unchanged = 0;  ///< segments that determine the scale; explained segments

  /// The ranges are from the data sheet; 0: unknown. Cost: O(samples).
  static PivotMotionCheck of(std::span<const ImuSample> samples, double gravity_m_s2, double gyro_range_rad_s,
                             double accel_range_m_s2);

  /// Returns `out_of_range` if inverted, relabelled or rescaled gyro axes explain clearly more time segments, or if the
  /// gyro's scale is wrong.
  Status verdict() const;
};

}  // namespace tumble
