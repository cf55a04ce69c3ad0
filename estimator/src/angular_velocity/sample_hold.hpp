// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "sample_hold_bounds.hpp"
#include "tumble/angular_velocity/detail/triad.hpp"
#include "tumble/common/imu.hpp"

namespace tumble {

/// RepeatedReadings describes the log of a gyro or accelerometer that is slower than the log. The log repeats the last
/// reading until the next reading (sample and hold).
struct RepeatedReadings {
  double period_s = 0.0;      ///< time between two readings
  double agreement = 0.0;     ///< fraction of samples whose repetitions a regular clock predicts
  std::vector<double> age_s;  ///< per sample: age of its reading in addition to window_lag_s
  std::vector<bool> repeats;  ///< per sample: reading equals that of the previous sample
  /// Time from the middle of a reading's averaging window to the middle of the sample's window, if both windows end
  /// together. A gyro averages over its period; an accelerometer averages over an unknown part of its period. See
  /// docs/maths/carried.md (C11), (C12).
  double window_lag_s = 0.0;

  bool steady() const { return agreement >= sample_hold::kAgreementMin; }
  /// Returns the age of a sample's reading: the time between the middles of both averaging windows.
  double reading_age_s(std::size_t sample) const { return age_s[sample] + window_lag_s; }
};

/// Detects repeated readings in a recording. Cost: O(N), plus tests of about 5000 clocks on at most 1000 samples.
/// Samples in motion have a rate above 0.3 rad/s. Returns nothing for fewer than 30 samples in motion, or if less than
/// a twentieth of the samples in motion repeat the previous reading. Period and phase belong to the regular clock that
/// best predicts the repetitions. Ages and window lag are zero if the best clock is wrong for more than 10 % of the
/// samples.
std::optional<RepeatedReadings> find_repeated(std::span<const ImuSample> samples, Triad triad);

/// Neighbours points to the nearest earlier and later samples whose reading differs, or null.
struct Neighbours {
  const ImuSample *before = nullptr, *after = nullptr;
};
/// Returns the neighbours of each sample. Cost: O(N). All samples of a run of equal readings (repetition, rest,
/// saturation) have the same neighbours.
std::vector<Neighbours> other_readings(std::span<const ImuSample> samples, Triad triad);

}  // namespace tumble
