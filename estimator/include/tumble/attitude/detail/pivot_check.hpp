// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <limits>
#include <span>

#include "tumble/common/status.hpp"
#include "tumble/common/types.hpp"

namespace tumble {

/// Checks axes, signs and scale of the gyro for a body that never rests, but is held by a hand, a hinge, or the ground.
/// Such a body rotates for one or two seconds about a point that hardly moves (pivot). PivotMotionCheck compares the
/// integrated specific force with its prediction for rotation about a pivot. The alternatives are the measured rates,
/// relabelled or inverted gyro axes, and half or twice the rate: imu_merge.md (I27), (I28), (I29), (I30).
///
/// PivotMotionCheck uses only unsaturated rates. The check does not detect faults if the body flies or rolls. It also
/// misses wrong axis labels during rotation about a single axis, and flips of all three accelerometer axes.
struct PivotMotionCheck {
  int reading = 0;                      ///< index of the best alternative of gyro axes and signs; 0: unchanged
  double log_evidence = 0.0;            ///< against the unchanged rates
  std::size_t comparable_segments = 0;  ///< time segments that the alternative or the unchanged rates explain
  std::size_t better_explained_segments = 0,
              worse_explained_segments = 0;  ///< number of segments that the alternative explains better, and worse
  double scale = 1.0;                        ///< best scale factor of the rates, from segments with a near pivot
  double scale_sigma = std::numeric_limits<double>::infinity();
  std::size_t gyro_scale_segments = 0,
              segments_explained_unchanged =
                  0;  ///< number of segments that determine the scale; number of explained segments

  /// Checks a recording. The ranges are from the data sheet; 0: unknown. Cost: O(samples).
  static PivotMotionCheck of(std::span<const ImuSample> samples, double gravity_m_s2, double gyro_range_rad_s,
                             double accel_range_m_s2);

  /// Returns `out_of_range` if inverted, relabelled or rescaled gyro axes explain clearly more time segments than the
  /// measured rates, or if the gyro's scale is wrong.
  Status verdict() const;
};

}  // namespace tumble
