// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "tumble/angular_velocity/rail_detector.hpp"
#include "tumble/angular_velocity/rail_planes.hpp"
#include "tumble/common/imu.hpp"

namespace tumble {

/// What the rails of an IMU are known to be.
struct KnownRails {
  RailDetector::State walls;  ///< levels of equal readings, stated ranges
  RailPlanes planes;          ///< of the gyro's elements, where they were seen
  bool upright = false;       ///< the device clips what it delivers: nothing is off on the axes beside

  /// The planes by which readings are judged: where rails are upright equal readings tell them to the bit, and planes
  /// what else there is.
  RailPlanes planes_in_use() const;
  bool operator==(const KnownRails&) const = default;
};

/// Finds which readings of a recording are clipped: the one judgement for all that reads recordings, from what the
/// device flags, levels of equal readings (RailDetector) and tilted planes (RailPlaneFinder).
class ClippingFinder {
 public:
  struct Params {
    RailDetector::Params walls;
    RailPlaneFinder::Params planes;  ///< without a stated range of its own: that of `walls`
  };
  struct Found {
    KnownRails rails;
    std::vector<Clipping> clippings;  ///< one per sample
  };

  /// Throws InvalidParams on a parameter outside of its bound.
  explicit ClippingFinder(const Params& params);

  /// Samples must be finite and in order of time. O(N) apart from the search of RailPlaneFinder.
  Found find(std::span<const ImuSample> samples) const;

  const RailDetector& walls() const { return walls_; }

 private:
  RailDetector walls_;
  RailPlaneFinder planes_, unstated_;  // the second where readings contradict the stated range
};

}  // namespace tumble
