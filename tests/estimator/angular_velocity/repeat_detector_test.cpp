// SPDX-License-Identifier: BSD-3-Clause
// Tests the detection, sample by sample, of a log that is faster than its sensor.
#include "tumble/angular_velocity/detail/repeat_detector.hpp"

#include "tests/testing.hpp"

namespace tumble {
namespace {

struct Watched {
  RepeatDetector::State state;
  int wrong = 0;  ///< misclassified samples (new or repeated) after the first 200
  double least_age = 100.0, largest_age = 0.0;
};

/// Simulates a turning body: the gyro reads every `period` samples, a quarter of a sample after the first. The rate
/// rises by 1e-4 rad/s per sample.
Watched detect_frozen_units(double period, double rate_rad_s, bool clipped = false) {
  Watched out;
  const RepeatDetector holds;
  double before = -1.0;
  for (int k = 0; k < 1200; ++k) {
    const double read = 0.25 + period * std::floor((k - 0.25) / period);
    ImuSample sample;
    sample.time_ns = k * TimeNs{10'000'000};
    sample.angular_velocity_rad_s = {rate_rad_s, 1e-4 * read, 0.0};
    sample.specific_force_m_s2 = {0.0, 1e-3 * k, 9.8};
    holds.observe_reading(sample, clipped, out.state);
    const RepeatedReading& gyro = out.state.for_triad(Triad::gyro);
    if (k >= 200 && gyro.repeats_reading != (read == before)) ++out.wrong;
    if (k >= 200 && !gyro.repeats_reading) {
      out.least_age = std::min(out.least_age, k - read);
      out.largest_age = std::max(out.largest_age, k - read);
    }
    before = read;
  }
  return out;
}

TEST(RepeatDetector, ReportsPeriodAndRepeats) {
  for (const double period : {1.25, 1.8, 3.3, 7.9}) {
    const Watched found = detect_frozen_units(period, 1.0);
    const RepeatedReading& gyro = found.state.for_triad(Triad::gyro);
    ASSERT_TRUE(gyro.is_slower_than_samples()) << period;
    EXPECT_NEAR(gyro.reading_period_samples, period, 0.01 * period);
    EXPECT_EQ(found.wrong, 0) << period;
    // the age that counts as half a sample is within one sample
    EXPECT_GE(found.least_age, 0.0);
    EXPECT_LT(found.largest_age, 1.0);
    // the accelerometer of the same log has a new reading in each sample
    EXPECT_FALSE(found.state.for_triad(Triad::accelerometer).is_slower_than_samples());
  }
}

TEST(RepeatDetector, WhatIsStaleIsTheSlopeTimesTheAge) {
  const Watched found = detect_frozen_units(3.3, 1.0);
  const RepeatedReading& gyro = found.state.for_triad(Triad::gyro);
  const double behind = gyro.age_samples + 0.5 * (gyro.reading_period_samples - 1.0);
  EXPECT_NEAR(gyro.change_since_new_reading().y(), 1e-4 * behind, 1e-4 * 0.05 * behind);
  EXPECT_EQ(gyro.change_since_new_reading().x(), 0.0);
}

// Controls: new readings each time, a body at rest, a frozen sensor.
TEST(RepeatDetector, SaysNothingOfOthers) {
  EXPECT_FALSE(detect_frozen_units(1.0, 1.0).state.for_triad(Triad::gyro).is_slower_than_samples());
  EXPECT_EQ(detect_frozen_units(1.0, 1.0).state.for_triad(Triad::gyro).change_since_new_reading(),
            Eigen::Vector3d::Zero());
  EXPECT_FALSE(detect_frozen_units(3.3, 0.0).state.for_triad(Triad::gyro).is_slower_than_samples());
  EXPECT_FALSE(detect_frozen_units(1e6, 1.0).state.for_triad(Triad::gyro).is_slower_than_samples());
  // at its limits on all axes
  EXPECT_FALSE(detect_frozen_units(3.3, 1.0, true).state.for_triad(Triad::gyro).is_slower_than_samples());
  // the sensor also
  // repeats readings
}

}  // namespace
}  // namespace tumble
