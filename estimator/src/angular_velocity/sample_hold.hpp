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

/// Readings of a triad whose own rate is below that of the log, so that some are said twice (sample and hold).
struct HeldReadings {
  double period_s = 0.0;      ///< from one reading to the next
  double agreement = 0.0;     ///< share of the samples whose being new or repeated a steady period explains
  std::vector<double> age_s;  ///< of each sample: how old its reading is beyond that of a reading taken at once
  std::vector<bool> repeats;  ///< it is the reading of the sample before
  /// By what the middle of a reading's window lies before that of a sample's, when it ends with the sample: a gyro
  /// integrates for its own period, an accelerometer for something between none and all of it. docs/maths/carried.md
  /// (C35), (C36).
  double window_lag_s = 0.0;

  bool steady() const { return agreement >= sample_hold::kAgreementMin; }
  /// How long before its stamp, and the window that ends there, a sample's reading tells of the motion.
  double behind_s(std::size_t sample) const { return age_s[sample] + window_lag_s; }
};

/// Finds them: none where fewer than a twentieth of the samples in motion (faster than 0.3 rad/s, 30 of them at least)
/// repeat all three numbers of the one before. Period and phase are those with which a steady clock explains best which
/// samples repeat; ages and the windows' lag follow from them, and are zero where no steady clock does (agreement below
/// 0.9). O(N) for each of some 5000 clocks, on 1000 samples at most.
std::optional<HeldReadings> find_held(std::span<const ImuSample> samples, Triad triad);

/// The samples nearest to one whose gyro (or accelerometer) says something else; null where there is none.
struct Neighbours {
  const ImuSample *before = nullptr, *after = nullptr;
};
/// Of each sample: a reading said twice has the same neighbours both times. Whole segments of equal readings (rest, a
/// level plateau) are stepped over likewise. O(N).
std::vector<Neighbours> other_readings(std::span<const ImuSample> samples, Triad triad);

}  // namespace tumble
