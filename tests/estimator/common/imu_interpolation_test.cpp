// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/common/detail/imu_average.hpp"

#include "tests/testing.hpp"

namespace tumble {
namespace {

/// Returns rates and forces that grow linearly with time, by whole numbers per millisecond, so that sums of few are
/// exact.
ImuSample on_the_line(TimeNs time_ns) {
  const double t_ms = static_cast<double>(time_ns) * 1e-6;
  return {time_ns, t_ms * Vector3d(2.0, -4.0, 8.0), t_ms * Vector3d(-16.0, 32.0, 1.0) + Vector3d::UnitZ(), 0};
}

std::vector<ImuSample> every_four_ms(int count) {
  std::vector<ImuSample> samples;
  for (int k = 0; k < count; ++k) samples.push_back(on_the_line(4'000'000 * k));
  return samples;
}

TEST(ImuInterpolation, FollowsALineBetweenReadingsAndBeyondThem) {
  const std::vector<ImuSample> samples = every_four_ms(6);
  ImuInterpolation imu(samples);
  for (const TimeNs time_ns : {-2'000'000, 0, 1'000'000, 3'000'000, 4'000'000, 11'000'000, 20'000'000, 21'000'000}) {
    const ImuSamplePair near = imu.samples_around(time_ns);
    EXPECT_EQ(near.is_inside_recording(), time_ns >= 0 && time_ns <= 20'000'000) << time_ns;
    EXPECT_EQ(near.index_after, near.index_before + 1);
    EXPECT_NEAR(near.length_s, 4e-3, 1e-18);
    const ImuSample found = imu.at(time_ns, near), expected = on_the_line(time_ns);
    EXPECT_EQ(found.time_ns, time_ns);
    // rounding errors of about a dozen numbers up to 700
    EXPECT_LT((found.angular_velocity_rad_s - expected.angular_velocity_rad_s).norm(), 1e-12) << time_ns;
    EXPECT_LT((found.specific_force_m_s2 - expected.specific_force_m_s2).norm(), 1e-12) << time_ns;
  }
}

TEST(ImuInterpolation, TheNextReadingsAreNotASecondAnswer) {
  // over a gap, the line of the two neighbours differs from that of the adjacent ones
  std::vector<ImuSample> samples = every_four_ms(4);
  samples[3].angular_velocity_rad_s *= 2.0;
  ImuInterpolation imu(samples);
  const TimeNs bent_ns = 10'000'000;
  const ImuSample found = imu.at(bent_ns, imu.samples_around(bent_ns));
  EXPECT_GT((found.angular_velocity_rad_s - on_the_line(bent_ns).angular_velocity_rad_s).norm(), 10.0);
}

TEST(ImuInterpolation, AReadingAtTheTimeComesBackBitByBit) {
  std::vector<ImuSample> samples = every_four_ms(3);
  for (ImuSample& sample : samples) sample.angular_velocity_rad_s += Vector3d(0.1, 0.7, 1e-9);
  samples[1].device_clip_flags = kClipGyroX;
  ImuInterpolation imu(samples);
  for (const ImuSample& sample : samples) {
    const ImuSample found = imu.at(sample.time_ns, imu.samples_around(sample.time_ns));
    EXPECT_EQ(found.angular_velocity_rad_s, sample.angular_velocity_rad_s);
    EXPECT_EQ(found.specific_force_m_s2, sample.specific_force_m_s2);
    EXPECT_EQ(found.device_clip_flags, sample.device_clip_flags);
  }
}

TEST(ImuInterpolation, WhatLiesBesideAClippedReadingIsClipped) {
  std::vector<ImuSample> samples = every_four_ms(3);
  samples[0].device_clip_flags = kClipGyroX;
  samples[1].device_clip_flags = kClipAccelZ;
  ImuInterpolation imu(samples);
  EXPECT_EQ(imu.at(1'000'000, imu.samples_around(1'000'000)).device_clip_flags, kClipGyroX | kClipAccelZ);
  EXPECT_EQ(imu.at(5'000'000, imu.samples_around(5'000'000)).device_clip_flags, kClipAccelZ);
}

}  // namespace
}  // namespace tumble
