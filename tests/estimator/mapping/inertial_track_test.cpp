// SPDX-License-Identifier: BSD-3-Clause
// Tests what the mapper derives from an IMU: the end of the initial rest, the bias, and the sweeps at rest.
#include "estimator/src/mapping/inertial_track.hpp"

#include "tests/testing.hpp"

namespace tumble::mapping {
namespace {

using Params = LidarInertialOdometry::Params;

const Eigen::Vector3d kBias_rad_s(0.01, -0.02, 0.005);

/// Listener receives samples of an IMU that are `step_ns` apart.
struct Listener {
  Params params = {};
  TimeNs step_ns = 10'000'000;
  InertialTrack track{params};
  TimeNs now_ns = 0;

  void hear(int samples, const Eigen::Vector3d& rate_rad_s, const Eigen::Vector3d& force_m_s2 = {0.0, 0.0, 9.80665},
            std::uint8_t clipped_axes = 0) {
    for (int k = 0; k < samples; ++k) {
      now_ns += step_ns;
      ImuSample sample;
      sample.time_ns = now_ns;
      sample.angular_velocity_rad_s = rate_rad_s;
      sample.specific_force_m_s2 = force_m_s2;
      AngularRateState rate;
      rate.time_ns = now_ns;
      rate.w_WI_I_rad_s = rate_rad_s;
      rate.clipped_axes = clipped_axes;
      track.store_sample(params, sample, rate);
    }
  }
  std::ptrdiff_t resting() const {
    return std::count_if(track.samples().begin(), track.samples().end(),
                         [](const MotionSample& sample) { return sample.at_rest; });
  }
};

/// Returns a gyro with noise of 6.5 mrad/s whose first two readings are 35 mrad/s apart: rare, but no motion.
Listener noisy_at_first() {
  Listener listener;
  const Eigen::Vector3d off_rad_s(0.0175, 0.0, 0.0);
  listener.hear(1, kBias_rad_s + off_rad_s);
  listener.hear(1, kBias_rad_s - off_rad_s);
  listener.hear(98, kBias_rad_s);
  return listener;
}

TEST(InertialTrack, NoiseOfTheFirstReadingsEndsNoRest) {
  Listener listener = noisy_at_first();
  EXPECT_EQ(listener.resting(), 100);
  listener.hear(1, kBias_rad_s + Eigen::Vector3d(0.0, 1.0, 0.0), {0.0, 0.0, 12.0});
  EXPECT_EQ(listener.resting(), 100);
  // the second reading is one of 99
  EXPECT_NEAR((listener.track.samples().back().w_WI_I_rad_s - Eigen::Vector3d(0.0, 1.0, 0.0)).norm(), 0.0175 / 99.0,
              1e-9);
  // negative control: after kBiasRest_s, a reading that differs by as much ends the rest
  Listener noisy_later;
  noisy_later.hear(20, kBias_rad_s);
  noisy_later.hear(1, kBias_rad_s + Eigen::Vector3d(0.035, 0.0, 0.0));
  noisy_later.hear(79, kBias_rad_s);
  EXPECT_EQ(noisy_later.resting(), 20);
}

TEST(InertialTrack, ARestOnceLeftDoesNotComeBack) {
  Listener listener;
  listener.hear(50, kBias_rad_s);
  listener.hear(10, Eigen::Vector3d(0.0, 3.0, 0.0));
  listener.hear(50, kBias_rad_s);
  EXPECT_EQ(listener.resting(), 50);
  EXPECT_NEAR(listener.track.samples().back().w_WI_I_rad_s.norm(), 0.0, 1e-12);
}

TEST(InertialTrack, ATooShortRestTeachesNoBias) {
  Listener listener;
  listener.hear(5, kBias_rad_s);
  listener.hear(1, Eigen::Vector3d(0.0, 3.0, 0.0));
  EXPECT_EQ(listener.track.samples().back().w_WI_I_rad_s, Eigen::Vector3d(0.0, 3.0, 0.0));
}

// readings take 10 ms, and motion within a reading is detected at its end
TEST(InertialTrack, AFastImuIsConstrainedOnlyWhileItRests) {
  Listener listener;
  listener.step_ns = 1'000'000;
  listener.hear(1004, kBias_rad_s);
  const Eigen::Vector3d push_rad_s(0.0, 5.0, 0.0);
  listener.hear(20, kBias_rad_s + push_rad_s);
  double rotated_rad = 0.0;
  for (const MotionSample& sample : listener.track.samples())
    rotated_rad += seconds(sample.time_ns - sample.from_ns) * sample.w_WI_I_rad_s.norm();
  EXPECT_NEAR(rotated_rad, 0.02 * push_rad_s.norm(), 1e-9);
  EXPECT_LE(listener.resting(), 1004);
  EXPECT_GT(listener.resting(), 1004 - 10);
}

TEST(InertialTrack, ASweepRestsWhileTheImuSaysNothingButGravity) {
  const auto rests = [](double later_force_m_s2, double later_rate_rad_s, std::uint8_t clipped_axes) {
    Listener listener;
    listener.hear(50, Eigen::Vector3d(0.0, 3.0, 0.0));
    listener.track.prune_until(listener.now_ns);
    listener.hear(5, Eigen::Vector3d::Zero(), {0.0, 0.0, 9.5});
    const TimeNs before_ns = listener.now_ns;
    listener.hear(5, {later_rate_rad_s, 0.0, 0.0}, {0.0, 0.0, later_force_m_s2}, clipped_axes);
    EXPECT_TRUE(listener.track.is_stationary_until(before_ns));
    return listener.track.is_stationary_until(listener.now_ns);
  };
  EXPECT_TRUE(rests(9.6, 0.0, 0));
  EXPECT_FALSE(rests(11.0, 0.0, 0));
  EXPECT_FALSE(rests(9.0, 0.0, 0));
  EXPECT_FALSE(rests(9.6, 0.1, 0));
  EXPECT_FALSE(rests(9.6, 0.0, 2));
}

// The window before a gap may itself be a gap at rest; no sample may overlap the previous one.
TEST(InertialTrack, SamplesDoNotOverlapWhateverTheirWindows) {
  Listener listener;
  listener.hear(30, Eigen::Vector3d::Zero());
  listener.now_ns += 290'000'000;
  listener.hear(1, Eigen::Vector3d::Zero());
  listener.now_ns += 110'000'000;
  listener.hear(1, Eigen::Vector3d(0.0, 3.0, 0.0));
  listener.now_ns += 190'000'000;
  listener.hear(3, Eigen::Vector3d(0.0, 3.0, 0.0));
  const auto samples = listener.track.samples();
  ASSERT_GT(samples.size(), 30u);
  for (std::size_t k = 1; k < samples.size(); ++k) EXPECT_EQ(samples[k].from_ns, samples[k - 1].time_ns) << k;
  EXPECT_TRUE(std::any_of(samples.begin(), samples.end(), [](const MotionSample& s) { return s.bridges_gap; }));
  for (const MotionSample& sample : samples) {
    if (!sample.bridges_gap) continue;
    EXPECT_GT(sample.rate_sigma_rad_s.minCoeff(), 0.1);
  }
}

}  // namespace
}  // namespace tumble::mapping
