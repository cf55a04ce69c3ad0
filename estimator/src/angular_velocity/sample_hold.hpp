// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "sample_hold_bounds.hpp"
#include "tumble/angular_velocity/detail/triad.hpp"
#include "tumble/common/types.hpp"

namespace tumble {

/// RepeatedReadings describes a gyro or accelerometer whose readings repeat in the log (sample and hold), because its
/// sample rate is lower than the rate of the log.
struct RepeatedReadings {
  double period_s = 0.0;  ///< time between two readings
  /// fraction of samples for which a clock with constant period predicts correctly whether the reading is repeated
  double regular_clock_fraction = 0.0;
  std::vector<double> age_s;             ///< per sample: age of its reading in addition to window_lag_s
  std::vector<bool> repeats_per_sample;  ///< per sample: whether the reading equals the previous sample's reading
  /// A gyro averages over its sample period. An accelerometer averages over an unknown part of its sample period:
  /// carried.md (C11), (C12).
  double window_lag_s = 0.0;

  bool has_regular_clock() const { return regular_clock_fraction >= sample_hold::kAgreementMin; }
  /// Returns the time from the middle of the sensor's averaging window to the middle of the sample period.
  double reading_age_s(std::size_t sample) const { return age_s[sample] + window_lag_s; }
};

/// Detects whether the log repeats readings of a sensor, and estimates period and phase of the sensor's clock from the
/// repetitions. Cost: O(N), plus a test of about 5000 candidate clocks on at most 1000 samples. Returns nothing if
/// fewer than 30 gyro readings exceed 0.3 rad/s, or if less than 5 % of the readings above 0.3 rad/s are repeated.
/// `age_s` is zero if no clock with constant period predicts the repetitions of 90 % of the samples.
std::optional<RepeatedReadings> find_repeated(std::span<const ImuSample> samples, Triad triad);

struct Neighbours {
  const ImuSample *previous_sample = nullptr, *next_sample = nullptr;
};
/// Returns for each sample the nearest earlier and later samples with a different reading. All samples of a run of
/// equal readings (repetition, rest, saturation) get the same earlier and later sample.
std::vector<Neighbours> neighbouring_readings(std::span<const ImuSample> samples, Triad triad);

}  // namespace tumble
