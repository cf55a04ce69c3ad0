// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "scenarios/estimates/method.hpp"
#include "scenarios/methods/registry.hpp"
#include "scenarios/methods/synthetic_recording.hpp"

// the test runs known errors of the published chain: they are reproduced where slam/published has a switch for them,
// and impossible elsewhere. The trim that counts unmatched slots is tested in trimmed_icp_test of the baselines, and
// angles beyond 90 degrees in score_test.
namespace tumble::scenarios {
namespace {

/// Returns a fast translation with hardly any rotation, so that only the velocity fed back differs.
testing::SyntheticMotion dash() {
  testing::SyntheticMotion motion;
  motion.angle_rad = 0.5;
  motion.displacement_m = {2.5, -2.0, 0.0};
  motion.start_m = {-1.0, 1.0, 1.0};
  motion.rail_rad_s = 100.0;
  return motion;
}

/// Returns the median error of the chain's velocity while the acceleration is large.
double velocity_error_m_s(double late_velocity) {
  const testing::SyntheticMotion motion = dash();
  const sim::Recording recording = testing::synthetic_rig(motion);
  sim::Values values;
  values.set("late_velocity", late_velocity);
  const Estimate estimate = find_methods("slam/published").at(0)->run(recording.sensors, values, {});
  EXPECT_TRUE(estimate.status.ok()) << estimate.status.message();
  std::vector<double> errors;
  for (const auto& sweep : estimate.sweeps) {
    const double t = 1e-9 * static_cast<double>(sweep.pose.time_ns);
    if (t < motion.start_s + 0.5 || t > motion.end_s - 0.5) continue;
    // only the speed is compared, because the estimate's world is turned against the true one
    errors.push_back(std::abs(sweep.pose.velocity_W_m_s.norm() - motion.velocity_m_s(t).norm()));
  }
  EXPECT_GT(errors.size(), 10u);
  if (errors.empty()) return 0.0;
  std::nth_element(errors.begin(), errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2), errors.end());
  return errors[errors.size() / 2];
}

TEST(PublishedErrors, VelocityIsHalfASweepLateAsLaunched) {
  const double late = velocity_error_m_s(1.0), in_time = velocity_error_m_s(0.0);
  // half a sweep of 0.1 s at 0.5 to 2 m/s^2 gives this error
  EXPECT_GT(late, 0.03);
  EXPECT_LT(in_time, 0.5 * late);
}

}  // namespace
}  // namespace tumble::scenarios
