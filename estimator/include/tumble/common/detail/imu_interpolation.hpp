// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>

#include "tumble/common/imu.hpp"

namespace tumble {

/// Where a time lies among the samples of an IMU.
struct ImuNeighbours {
  std::size_t before = 0, after = 0;  ///< neighbouring samples; at either end the two there
  double share = 0.0;     ///< of the way from one to the other; below 0 before the first, above 1 after the last
  double length_s = 0.0;  ///< from one to the other
  bool between() const { return share >= 0.0 && share <= 1.0; }
};

/// One IMU read at the stamps of another. Stamps are ends of windows, so what lies linearly between two readings is
/// taken for the mean over a window that ends there; windows of another length, and what turns within, are not
/// modelled.
class ImuInterpolation {
 public:
  /// Of at least two samples that rise in time, which have to outlive it.
  explicit ImuInterpolation(std::span<const ImuSample> samples) : samples_(samples) {}

  /// Neighbours of `time_ns`, which must not fall from call to call. Amortised O(1).
  ImuNeighbours around(TimeNs time_ns);

  /// The reading there, on the line through the two, the flags of both; of one that was read there, bit by bit it.
  ImuSample at(TimeNs time_ns, const ImuNeighbours& neighbours) const;

 private:
  std::span<const ImuSample> samples_;
  std::size_t after_ = 1;
};

}  // namespace tumble
