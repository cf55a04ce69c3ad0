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

/// RepeatedReadings describes how a log repeats the readings of a gyro or accelerometer that is slower than the log
/// (sample and hold).
struct RepeatedReadings {
  double period_s = 0.0;      ///< time between two readings
  double agreement = 0.0;     ///< fraction of samples that a regular clock explains
  std::vector<double> age_s;  ///< per sample: age of its reading in addition to window_lag_s
  std::vector<bool> repeats;  ///< the reading equals the previous sample's
  /// Time from the middle of a reading's window to the middle of the sample's window, if both windows end together. A
  /// gyro integrates over its period; an accelerometer integrates over an unknown part of its period. See
  /// docs/maths/carried.md (C11), (C12).
  double window_lag_s = 0.0;

  bool steady() const { return agreement >= sample_hold::kAgreementMin; }
  /// Returns the age of a sample's reading, between the middles of both averaging windows.
  double reading_age_s(std::size_t sample) const { return age_s[sample] + window_lag_s; }
};

/// Detects repeated readings in a recording. Cost: O(N), plus tests of about 5000 clocks on at most 1000 samples.
/// Returns nothing if less than a twentieth of the samples in motion (above 0.3 rad/s, at least 30 samples) repeat the
/// previous reading. Period and phase are those of the regular clock that best explains the repetitions. Ages and
/// window lag are zero if no regular clock explains 90 % of the samples.
std::optional<RepeatedReadings> find_repeated(std::span<const ImuSample> samples, Triad triad);

/// Neighbours points to the nearest earlier and later samples with a different reading, or null.
struct Neighbours {
  const ImuSample *before = nullptr, *after = nullptr;
};
/// Returns the neighbours of each sample. Cost: O(N). All samples of a run of equal readings (repetition, rest,
/// saturation) have equal neighbours.
std::vector<Neighbours> other_readings(std::span<const ImuSample> samples, Triad triad);

}  // namespace tumble
