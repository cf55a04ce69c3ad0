// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>

#include "tumble/common/types.hpp"

namespace tumble {

struct ImuSamplePair {
  std::size_t index_before = 0,
              index_after = 0;        ///< neighbouring samples; outside of the recording, the two samples at its end
  double interpolation_weight = 0.0;  ///< weight of the later sample; not within [0, 1] outside of the recording
  double length_s = 0.0;
  bool is_inside_recording() const { return interpolation_weight >= 0.0 && interpolation_weight <= 1.0; }
};

/// Interpolates the readings of one IMU linearly at the time stamps of another IMU. Different averaging windows of the
/// two IMUs, and rotation within a window, are neglected.
class ImuInterpolation {
 public:
  /// The constructor needs at least two samples with increasing time stamps, which must outlive the object.
  explicit ImuInterpolation(std::span<const ImuSample> samples) : samples_(samples) {}

  /// Returns the neighbours of `time_ns`, which must not decrease from call to call. Cost: amortised O(1).
  ImuSamplePair samples_around(TimeNs time_ns);

  /// Returns the interpolated reading, with the clip flags of both neighbours. At the time of a sample, the result
  /// equals the sample bit for bit.
  ImuSample at(TimeNs time_ns, const ImuSamplePair& neighbours) const;

 private:
  std::span<const ImuSample> samples_;
  std::size_t index_after_ = 1;
};

}  // namespace tumble
