// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>

#include "tumble/angular_velocity/detail/triad.hpp"
#include "tumble/common/types.hpp"

namespace tumble {

/// Repetition of a reading in consecutive samples (sample and hold), which occurs if the sensor updates more slowly
/// than the log.
struct RepeatedReading {
  bool repeats_reading = false;
  double age_samples = 0.0;             ///< mean age of the reading at the sample's time stamp
  double reading_period_samples = 1.0;  ///< number of samples per new reading; 1: no repetition
  Eigen::Vector3d reading_change =
      Eigen::Vector3d::Zero();  ///< new reading minus previous reading [unit of the reading]

  bool is_slower_than_samples() const { return reading_period_samples > 1.0; }
  /// Returns the time from the middle of the reading's averaging window to the middle of the sample's averaging window,
  /// in samples.
  double delay_samples() const {
    return is_slower_than_samples() ? age_samples + 0.5 * (reading_period_samples - 1.0) : 0.0;
  }
  /// Returns the extrapolated change of the signal since the last new reading, with the slope between the last two
  /// readings.
  Eigen::Vector3d change_since_new_reading() const;
  bool operator==(const RepeatedReading&) const = default;
};

/// Detects, sample by sample, whether a log has a higher sample rate than the sensor and repeats readings:
/// rate_stream.md (R95). The age of a new reading is 0.5 +- 0.29 samples, because the phase of the sensor's clock is
/// unknown.
class RepeatDetector {
 public:
  struct RepetitionMemory {
    Eigen::Vector3d reading = Eigen::Vector3d::Zero();
    double equal_samples = 0.0;
    double moving = 0.0,
           repeated = 0.0;  ///< number of samples in motion, and of repetitions among them; both decay slowly
    RepeatedReading now;
    bool operator==(const RepetitionMemory&) const = default;
  };
  struct State {
    std::array<RepetitionMemory, 2> repetition;  ///< indexed by Triad
    const RepeatedReading& for_triad(Triad triad) const { return repetition[static_cast<std::size_t>(triad)].now; }
    bool operator==(const State&) const = default;
  };

  /// Processes a finite sample. Samples with `clipped` are ignored, because a clipped gyro repeats its reading at any
  /// update rate. Cost: O(1), no allocation.
  void observe_reading(const ImuSample& sample, bool clipped, State& state) const;
};

}  // namespace tumble
