// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/mapping/detail/localisation.hpp"

#include "oracles/gaussian.hpp"
#include "tests/testing.hpp"

namespace tumble {
namespace {

constexpr double kGravity = 9.80665;

struct Flight {
  std::vector<ImuSample> samples;
  std::vector<SweepResult> sweeps;
};

// Returns hops of 0.8 s, spinning about the vertical: a parabola each, with p in closed form; sweeps of 0.1 s.
Flight hops(double scale, double noise_m) {
  constexpr double kDt_s = 0.01, kSpin_rad_s = 4.0, kUp_m_s = 0.5 * kGravity * 0.8;
  constexpr int kHop = 80;
  oracles::Gaussian noise(11);
  Flight out;
  SweepResult sweep;
  for (int k = 0; k <= 400; ++k) {
    const double t_s = kDt_s * k, in_hop_s = kDt_s * (k % kHop);
    ImuSample sample;
    sample.time_ns = TimeNs{k} * 10'000'000;
    // the impact on the ground, about the start of a hop
    if (k >= kHop && k % kHop < 2) sample.specific_force_m_s2.z() = kUp_m_s / kDt_s;
    out.samples.push_back(sample);
    PoseState pose;
    pose.time_ns = sample.time_ns;
    pose.orientation_W = Eigen::AngleAxisd(kSpin_rad_s * t_s, Eigen::Vector3d::UnitZ());
    pose.position_W_m = {1.5 * t_s, 0.0, kUp_m_s * in_hop_s - 0.5 * kGravity * in_hop_s * in_hop_s};
    for (int j = 0; j < 3; ++j) pose.position_W_m[j] = scale * pose.position_W_m[j] + noise_m * noise();
    sweep.trajectory.push_back(pose);
    if (k == 0 || k % 10 != 0) continue;
    sweep.pose = pose;
    sweep.verdict = SweepVerdict::registered;
    out.sweeps.push_back(sweep);
    sweep.trajectory.clear();
  }
  return out;
}

TEST(LidarScale, IsThatOfTheRanges) {
  for (const double scale : {0.9, 1.0, 1.1}) {
    const Flight flight = hops(scale, 0.005);
    const LidarScale found = find_sweep_scale(flight.samples, flight.sweeps, kGravity);
    EXPECT_GT(found.velocity_change_count, 20u);
    EXPECT_NEAR(found.scale, scale, 5.0 * found.sigma + 0.01) << scale;
    EXPECT_LT(found.sigma, 0.01);
    EXPECT_EQ(found.is_inconsistent(), scale != 1.0) << found.scale << " +- " << found.sigma;
  }
}

// Sweep by sweep, the slope is the same, and later sweeps do not change earlier results.
// After a start in motion, the tilt is uncertain, and gravity along a wrong vertical changes the IMU's velocity.
TEST(LidarScale, IsLessCertainWhileTheTiltIsUncertain) {
  Flight forward;  // accelerates along x with 1 m/s^2
  for (int k = 1; k <= 400; ++k) {
    const double t_s = 0.01 * k;
    forward.samples.push_back({TimeNs{k} * 10'000'000, Eigen::Vector3d::Zero(), {1.0, 0.0, kGravity}, 0});
    if (k % 10 != 0) continue;
    SweepResult& sweep = forward.sweeps.emplace_back();
    sweep.pose.time_ns = forward.samples.back().time_ns;
    sweep.pose.position_W_m.x() = 0.5 * t_s * t_s;
    sweep.verdict = SweepVerdict::registered;
    sweep.trajectory = {sweep.pose};
  }
  const double sigma = find_sweep_scale(forward.samples, forward.sweeps, kGravity).sigma;
  for (SweepResult& sweep : forward.sweeps) sweep.pose.covariance(4, 4) = 0.02 * 0.02;
  // the bias alone gives an error of 0.05 m/s^2, the tilt alone 0.02 rad * 9.8 m/s^2
  EXPECT_NEAR(find_sweep_scale(forward.samples, forward.sweeps, kGravity).sigma / sigma, std::hypot(0.05, 0.196) / 0.05,
              0.05);
}

TEST(LidarScale, IsReportedWhileSweepsCome) {
  for (const double scale : {0.9, 1.0, 1.1}) {
    const Flight flight = hops(scale, 0.005);
    LidarScaleEstimator watch(kGravity, 200);
    std::size_t next = 0;
    for (const SweepResult& sweep : flight.sweeps) {
      for (; next < flight.samples.size() && flight.samples[next].time_ns <= sweep.pose.time_ns; ++next)
        watch.add(flight.samples[next]);
      watch.add(sweep);
      EXPECT_TRUE(scale != 1.0 || watch.scale().verdict().ok()) << watch.scale().verdict().message();
    }
    const LidarScale whole = find_sweep_scale(flight.samples, flight.sweeps, kGravity);
    EXPECT_EQ(watch.scale().velocity_change_count, whole.velocity_change_count);
    EXPECT_NEAR(watch.scale().scale, whole.scale, 1e-6);
    EXPECT_EQ(watch.scale().verdict().ok(), scale == 1.0);
  }
}

TEST(LidarScale, ALidarThatIsSilentForTooLongIsNotCompared) {
  const Flight flight = hops(1.1, 0.005);
  LidarScaleEstimator watch(kGravity, 50);
  std::size_t next = 0;
  for (const SweepResult& sweep : flight.sweeps) {
    for (; next < flight.samples.size() && flight.samples[next].time_ns <= sweep.pose.time_ns; ++next)
      watch.add(flight.samples[next]);
    watch.add(sweep);
  }
  EXPECT_EQ(watch.scale().velocity_change_count, 0u);
}

// The force inside a gap of the IMU data is unknown, for example the impact of the second hop.
TEST(LidarScale, NothingIsComparedOverAGapOfTheImu) {
  Flight flight = hops(1.0, 0.005);
  const std::size_t all = find_sweep_scale(flight.samples, flight.sweeps, kGravity).velocity_change_count;
  const auto lost = [](const ImuSample& sample) {
    return (sample.time_ns > 750'000'000 && sample.time_ns < 850'000'000) ||
           (sample.time_ns > 2'350'000'000 && sample.time_ns < 2'450'000'000);
  };
  std::erase_if(flight.samples, lost);
  const LidarScale found = find_sweep_scale(flight.samples, flight.sweeps, kGravity);
  EXPECT_GT(found.velocity_change_count, 5u);
  EXPECT_LT(found.velocity_change_count, all - 10);
  EXPECT_FALSE(found.is_inconsistent()) << found.scale << " +- " << found.sigma;
}

TEST(LidarScale, NothingIsReportedWithoutEvidence) {
  const Flight flight = hops(1.1, 0.005);
  EXPECT_FALSE(find_sweep_scale({}, {}, kGravity).is_inconsistent());
  EXPECT_FALSE(find_sweep_scale(flight.samples, {}, kGravity).is_inconsistent());
  EXPECT_FALSE(find_sweep_scale({}, flight.sweeps, kGravity).is_inconsistent());
  Flight lost = flight;
  for (auto& sweep : lost.sweeps) sweep.verdict = SweepVerdict::rejected;
  EXPECT_EQ(find_sweep_scale(lost.samples, lost.sweeps, kGravity).velocity_change_count, 0u);
  Flight railed = flight;
  for (ImuSample& sample : railed.samples) sample.device_clip_flags = kClipAccelZ;
  EXPECT_EQ(find_sweep_scale(railed.samples, railed.sweeps, kGravity).velocity_change_count, 0u);
  // at rest, the result is independent of the map's size: gravity and the ground's force cancel
  Flight rest = flight;
  for (ImuSample& sample : rest.samples) sample.specific_force_m_s2 = {0.0, 0.0, kGravity};
  EXPECT_EQ(find_sweep_scale(rest.samples, rest.sweeps, kGravity).velocity_change_count, 0u);
}

TEST(LidarScale, PlacesAsUncertainAsTheScaleAreNotTakenForOne) {
  const Flight flight = hops(1.03, 0.2);
  const LidarScale found = find_sweep_scale(flight.samples, flight.sweeps, kGravity);
  EXPECT_GT(found.sigma, 0.01);
  EXPECT_FALSE(found.is_inconsistent()) << found.scale << " +- " << found.sigma;
}

TEST(LidarScale, AFindingEndsAMinuteAfterItsCause) {
  const Flight flight = hops(1.1, 0.005);
  LidarScaleEstimator watch(kGravity, 200);
  std::size_t next = 0;
  for (const SweepResult& sweep : flight.sweeps) {
    for (; next < flight.samples.size() && flight.samples[next].time_ns <= sweep.pose.time_ns; ++next)
      watch.add(flight.samples[next]);
    watch.add(sweep);
  }
  ASSERT_FALSE(watch.scale().verdict().ok());
  SweepResult later = flight.sweeps.back();
  for (int k = 0; k < 56; ++k) {  // afterwards, fewer than four separate changes are left
    later.pose.time_ns += 1'000'000'000;
    watch.add(later);
  }
  EXPECT_FALSE(watch.scale().verdict().ok());
  for (int k = 0; k < 5; ++k) {
    later.pose.time_ns += 1'000'000'000;
    watch.add(later);
  }
  EXPECT_TRUE(watch.scale().verdict().ok());
}

}  // namespace
}  // namespace tumble
