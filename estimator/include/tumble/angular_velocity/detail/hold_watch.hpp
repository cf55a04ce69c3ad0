// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>

#include "tumble/angular_velocity/detail/triad.hpp"
#include "tumble/common/imu.hpp"

namespace tumble {

/// One triad's part of a sample, as it is when the sample arrives: of a sensor that is slower than the log a reading
/// that was said before, or one that came at some time since the last sample (sample and hold).
struct HeldReading {
  bool repeats = false;         ///< the reading of the sample before
  double age_samples = 0.0;     ///< mean time for which it has waited
  double period_samples = 1.0;  ///< from one reading to the next; 1: each sample has a reading of its own
  Eigen::Vector3d change = Eigen::Vector3d::Zero();  ///< from the reading before it [unit of the triad]

  bool held() const { return period_samples > 1.0; }
  /// By how much the middle of a window as long as the period, which ended when the reading was taken, lies before that
  /// of the sample's own.
  double behind_samples() const { return held() ? age_samples + 0.5 * (period_samples - 1.0) : 0.0; }
  /// What the triad may have changed by in that time, at the slope of the last change.
  Eigen::Vector3d stale() const;
  bool operator==(const HeldReading&) const = default;
};

/// Tells a log that is faster than its sensor as the samples arrive: the causal form of find_held, without the phase of
/// the sensor's clock, so that a new reading is half a sample old, +- 0.29 of one. docs/maths/rate_stream.md (R97).
class HoldWatch {
 public:
  /// Of one triad.
  struct Memory {
    Eigen::Vector3d reading = Eigen::Vector3d::Zero();
    double said = 0.0;                    ///< samples in a row that say it
    double moving = 0.0, repeated = 0.0;  ///< samples in motion, those of them that repeat; forgotten slowly
    HeldReading now;
    bool operator==(const Memory&) const = default;
  };
  struct State {
    std::array<Memory, 2> memory;  ///< by Triad
    const HeldReading& of(Triad triad) const { return memory[static_cast<std::size_t>(triad)].now; }
    bool operator==(const State&) const = default;
  };

  /// Takes the next finite sample. O(1), no allocation. A gyro that is `clipped` may repeat whatever its own rate is:
  /// such a sample is not counted.
  void observe(const ImuSample& sample, bool clipped, State& state) const;
};

}  // namespace tumble
