// SPDX-License-Identifier: BSD-3-Clause
// The odometry classes on samples with stamps of a host.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "answers.hpp"
#include "rolled_sphere.hpp"
#include "thrown_body.hpp"
#include "thrown_params.hpp"
#include "tumble/odometry/expert_params.hpp"
#include "tumble/tumble.hpp"

namespace tumble {
namespace {

using test::ThrownBody;

/// As a host stamps: up to `most_ns` early and late, by the same numbers each time.
std::vector<ImuSample> stamped_by_a_host(std::vector<ImuSample> imu, std::uint32_t most_ns = 2'000'000) {
  std::uint32_t random = 1;
  for (ImuSample& sample : imu) {
    random = random * 1664525u + 1013904223u;
    sample.time_ns += static_cast<TimeNs>(random % (2 * most_ns + 1)) - most_ns;
  }
  return imu;
}

std::vector<AngularRateState> rates_of(TumblingOdometry& odometry, const std::vector<ImuSample>& imu) {
  std::vector<AngularRateState> out;
  for (const ImuSample& sample : imu) {
    EXPECT_TRUE(odometry.add_imu(sample).ok());
    const std::optional<AngularRateState>& rate = odometry.newest_smoothed_rate();
    if (rate && (out.empty() || rate->time_ns > out.back().time_ns)) out.push_back(*rate);
  }
  return out;
}

TEST(Stamps, ThatJitterMoveNoRate) {
  const ThrownBody body{.rest_s = 2.5, .end_s = 4.7};
  const std::vector<ImuSample> exact = body.imu(), stamped = stamped_by_a_host(exact);
  TumblingOdometry own_clock(params_of(body)), host_clock(params_of(body));
  TumblingParams uncorrected = params_of(body);
  uncorrected.expert->stamps.correctable_jitter_max_periods = 0.0;
  TumblingOdometry without(uncorrected);
  const std::vector<AngularRateState> expected = rates_of(own_clock, exact), found = rates_of(host_clock, stamped),
                                      control = rates_of(without, stamped);
  EXPECT_FALSE(own_clock.estimated_jitter_s());
  ASSERT_TRUE(host_clock.estimated_jitter_s());
  EXPECT_NEAR(*host_clock.estimated_jitter_s(), 1.15e-3, 0.3e-3);  // of the uniform distribution
  EXPECT_FALSE(without.estimated_jitter_s());
  ASSERT_EQ(found.size(), expected.size());
  double moved_ns = 0.0, left_as_stamped_ns = 0.0;
  int turning = 0;
  for (std::size_t k = 0; k < found.size(); ++k) {
    if (expected[k].w_WI_I_rad_s.norm() < 1.0) continue;
    ++turning;
    moved_ns = std::max(moved_ns, std::abs(double(found[k].time_ns - expected[k].time_ns)));
    left_as_stamped_ns = std::max(left_as_stamped_ns, std::abs(double(control[k].time_ns - expected[k].time_ns)));
  }
  EXPECT_GT(turning, 80);
  EXPECT_LT(moved_ns, 1e6);              // a line through 200 stamps
  EXPECT_GT(left_as_stamped_ns, 1.9e6);  // negative control
}

TEST(Stamps, ThatAreRefusedHaveNoPartInTheClock) {
  const ThrownBody body;
  TumblingOdometry odometry(params_of(body)), undisturbed(params_of(body));
  for (const ImuSample& sample : stamped_by_a_host(body.imu())) {
    ImuSample wrong = sample;
    wrong.time_ns += 5'000'000'000;
    if (odometry.newest_imu_time_ns()) {
      EXPECT_EQ(odometry.add_imu(wrong).error_code, ErrorCode::gap);
    }
    ASSERT_TRUE(odometry.add_imu(sample).ok());
    ASSERT_TRUE(undisturbed.add_imu(sample).ok());
  }
  EXPECT_EQ(test::answers(odometry), test::answers(undisturbed));
}

struct Rolled {
  double worst_m = 0.0;  ///< of the live poses from where the sphere was at their times, from the start of the roll on
  std::optional<double> estimated_jitter_s;
};

Rolled rolled(const std::vector<ImuSample>& samples, double jitter_max) {
  RollingOdometry::Params params = test::params_of({test::kPositions[0]});
  params.lag_s = 0.0;
  params.expert->stamps.correctable_jitter_max_periods = jitter_max;
  RollingOdometry odometry(params);
  Rolled out;
  for (const ImuSample& sample : samples) {
    EXPECT_TRUE(odometry.add_imu(sample).ok());
    while (const std::optional<RollingOdometry::Pose> pose = odometry.take()) {
      const double x_m = test::kRadius_m * test::angle_rad(seconds(pose->pose.time_ns));
      if (seconds(pose->pose.time_ns) > test::kRest_s)
        out.worst_m = std::max(out.worst_m, std::abs(pose->pose.position_W_m.x() - x_m));
    }
  }
  out.estimated_jitter_s = odometry.estimated_jitter_s();
  return out;
}

TEST(Stamps, ThatJitterMoveNoSphere) {
  const std::vector<ImuSample> exact = test::unit_at(test::kPositions[0]), stamped = stamped_by_a_host(exact, 800'000);
  const Rolled own = rolled(exact, 0.15), corrected = rolled(stamped, 0.15), uncorrected = rolled(stamped, 0.0);
  EXPECT_LT(corrected.worst_m, own.worst_m + 3e-4);          // 1.7 m/s at most, for a tenth of the jitter
  EXPECT_GT(uncorrected.worst_m, corrected.worst_m + 2e-4);  // negative control
  EXPECT_FALSE(own.estimated_jitter_s);
  ASSERT_TRUE(corrected.estimated_jitter_s);
  EXPECT_NEAR(*corrected.estimated_jitter_s, 0.46e-3, 0.15e-3);  // of the uniform distribution
  EXPECT_FALSE(uncorrected.estimated_jitter_s);
}

}  // namespace
}  // namespace tumble
